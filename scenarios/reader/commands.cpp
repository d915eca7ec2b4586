// Commands and sinks of a scenario.
#include <algorithm>

#include "scenarios/reader/builder.hpp"
#include "sim/stream/command_models.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {

void Builder::readCommands(const Record& scenario) {
  if (!scenario.given("commands")) return;
  for (const Value& v : scenario.value("commands").items) simulation_.commands.push_back(readCommand(v, simulation_, simulation_.time.start_s));
  std::stable_sort(simulation_.commands.begin(), simulation_.commands.end(), [](const Command& a, const Command& b) { return a.at_s < b.at_s; });
}

void Builder::readSinks(const Record& scenario) {
  if (!scenario.given("sinks")) return;
  for (const Value& v : scenario.value("sinks").items) simulation_.sinks.push_back(readSink(v, simulation_));
}

}  // namespace pitviper
