#include "scenarios/commands/scenario_wish.hpp"

#include "scenarios/reader/scenario_reader.hpp"

namespace pitviper {

Simulation ScenarioWish::read() const { return readScenario(file, changes, findLibraries(), roots); }

std::vector<Option> scenarioOptions(ScenarioWish& w, const std::string& needs) {
  return {{"--set", "PATH=VALUE...",
           "replaces or adds a value: --set cameras.0.samples=2, --set cameras.seeker.exposure='1 ms', --set entities.jet.temperature='300 K'; list items by "
           "number or by their name; --set parameters.speed='300 m/s' a parameter of the scenario",
           into(w.changes), needs},
          rootOption(w, needs)};
}

Option rootOption(ScenarioWish& w, const std::string& needs) {
  return {"--root", "FOLDER...", "a folder, besides the scenario's own, from which it may include and extend files", into(w.roots), needs};
}

std::pair<int, int> framesWanted(const std::string& text, const Simulation& sim) {
  if (text.empty()) return {0, sim.time.frames - 1};
  const auto [a, b] = readRange(text, "--frames");
  if (a < 0 || b < a || b >= sim.time.frames)
    throw UserError({"--frames " + text, 0, 0, -1}, "there is no such range of frames", "within 0:" + std::to_string(sim.time.frames - 1) + ", rising",
                    "choose frames of the scenario's 'time.frames'");
  return {static_cast<int>(a), static_cast<int>(b)};
}

}  // namespace pitviper
