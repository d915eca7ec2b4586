#include "scenarios/commands/first_bench.hpp"

#include <algorithm>
#include <sstream>

#include "scenarios/commands/child_run.hpp"
#include "scenarios/commands/print.hpp"
#include "scenarios/commands/process.hpp"
#include "scenarios/commands/scenario_changes.hpp"

namespace pitviper {
namespace {

constexpr int kEndedBySignals = 128;

/// What a process said that is no figure.
std::string otherWords(const std::string& output) {
  std::istringstream in(output);
  std::string words;
  for (std::string line; std::getline(in, line);)
    if (!line.starts_with("figure ") && !line.empty()) words += (words.empty() ? "" : "\n") + line;
  return words;
}

class Measuring {
 public:
  explicit Measuring(const OnceRequest& request) : request_(request) {}

  FirstFigures measure(const std::vector<std::string>& sets) {
    const auto& [scenario, frames, most_s] = request_;
    Arguments arguments{"bench", "--once", scenario.file, "--frames", std::to_string(frames), "--seconds", print("%.9g", most_s)};
    for (const std::vector<std::string>& all : {scenario.changes, sets})
      for (const std::string& set : all) arguments.insert(arguments.end(), {"--set", set});
    for (const auto& root : scenario.roots) arguments.insert(arguments.end(), {"--root", root.string()});
    const std::size_t before = cache_.driverFiles();
    const ChildResult result = runChild(arguments, cache_.environment());
    const std::string words = otherWords(result.output);
    if (result.code != 0) throw FirstFailure(words.empty() ? scenario.file + ": its process ended with " + std::to_string(result.code) : words, result.code);
    if (!words.empty() && words != said_) tell((said_ = words).c_str());
    FirstFigures figures = readFigures(result.output);
    figures["compiled"] = static_cast<double>(cache_.driverFiles()) - static_cast<double>(before);
    return figures;
  }
  void mark() { cache_.mark(); }
  void back() { cache_.back(); }

 private:
  const OnceRequest& request_;
  OwnCache cache_;
  std::string said_;
};

}  // namespace

std::vector<std::string> firstStateNames() {
  std::vector<std::string> names{"first", "second"};
  names.insert(names.end(), scenarioChangeNames().begin(), scenarioChangeNames().end());
  return names;
}

std::vector<FirstState> measureFirst(const FirstRequest& request, const std::function<void(const std::string&)>& next) {
  const auto wanted = [&](const std::string& state) { return std::find(request.states.begin(), request.states.end(), state) != request.states.end(); };
  Measuring measuring(request.once);
  std::vector<FirstState> states;
  next("first");
  states.push_back({"first", "nothing cached", true, measuring.measure({})});
  if (wanted("second")) {
    next("second");
    states.push_back({"second", "the same again", true, measuring.measure({})});
  }
  measuring.mark();
  const auto& names = scenarioChangeNames();
  if (std::none_of(names.begin(), names.end(), wanted)) return states;
  for (const ScenarioChange& change : changesOf(request.once.scenario)) {
    if (!wanted(change.name)) continue;
    FirstState state{change.name, change.words, false, {}};
    next(change.name);
    if (!change.sets.empty()) {
      measuring.back();
      try {
        state.figures = measuring.measure(change.sets);
        state.measured = true;
      } catch (const FirstFailure& failure) {
        if (failure.code() >= kEndedBySignals) throw;
        state.words += ": " + std::string(failure.what());
      }
    }
    states.push_back(std::move(state));
  }
  return states;
}

}  // namespace pitviper
