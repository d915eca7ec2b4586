#include <algorithm>
#include <cstdio>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/first_once.hpp"
#include "scenarios/commands/first_report.hpp"
#include "scenarios/commands/process.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/image/atomic_file.hpp"

namespace pitviper {
namespace {

/// --frames, --seconds, --set and --root.
std::vector<Option> onceOptions(OnceRequest& r) {
  return joined(
      {{"--frames", "N", "after the first, at most", number(r.frames, {0, 100000, "", false, "not a number of frames after the first"})},
       {"--seconds", "S", "that they may take in each state: fewer of slow ones", number(r.most_s, {0.0, 1e9, "s", true, "not a time that frames may take"})}},
      scenarioOptions(r.scenario));
}

std::vector<std::string> shippedScenarios() {
  const std::filesystem::path folder = findLibraries().materials.parent_path().parent_path() / "scenarios";
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".yaml") all.push_back(entry.path().string());
  std::sort(all.begin(), all.end());
  return all;
}

struct FirstWish {
  FirstRequest request;
  std::string out;
};

int first(FirstWish& w, std::vector<std::string> scenarios) {
  FirstRequest& request = w.request;
  const std::vector<std::string> all = firstStateNames();
  std::vector<std::string> states;  // in their order
  for (const std::string& name : all)
    if (name == "first" || request.states.empty() || std::find(request.states.begin(), request.states.end(), name) != request.states.end())
      states.push_back(name);
  request.states = states;
  if (scenarios.empty()) scenarios = shippedScenarios();
  const std::filesystem::path out = w.out;
  if (!out.empty()) ensureWritableFolder(out);
  std::vector<FirstRow> rows;
  int code = 0;
  for (const std::string& scenario : scenarios) {
    Progress progress("bench", static_cast<int>(states.size()));
    bool begun = false;
    try {
      request.once.scenario.file = scenario;
      rows.push_back({scenario, measureFirst(request, [&](const std::string& state) {
                        if (begun) progress.step();
                        begun = true;
                        progress.phase(scenario + ", " + state);
                      })});
    } catch (const FirstFailure& failure) {
      progress.withdraw();
      tell(failure.what());
      if (failure.code() >= 128) return failure.code();
      code = std::max(code, failure.code());
      continue;
    }
    progress.withdraw();
    std::printf("%s\n", firstTable(rows.back()).c_str());
    std::fflush(stdout);
    if (!out.empty()) writeFileAtomically(out / "first.csv", firstCsv(rows));  // after each: what ends it takes nothing that was measured
  }
  if (rows.size() > 1) std::printf("%s\n", firstSummary(rows, states).c_str());
  if (!out.empty() && !rows.empty()) std::printf("%s written\n", (out / "first.csv").string().c_str());
  return code;
}

}  // namespace

CommandLine onceBenchCommand() {
  const auto w = std::make_shared<OnceRequest>();
  return {"bench --once",
          "SCENARIO.yaml",
          "",
          "One state of bench --first by itself, with what is cached now, a figure a line.",
          onceOptions(*w),
          "",
          [w](const Arguments& words) {
            w->scenario.file = words[0];
            std::fputs(writeFigures(measureOnce(*w)).c_str(), stdout);
            return 0;
          }};
}

CommandLine firstBenchCommand() {
  const auto w = std::make_shared<FirstWish>();
  return {
      "bench --first",
      "[SCENARIO.yaml]...",
      "",
      "How long one waits for a picture. Each scenario (without one: all that are shipped) from nothing cached, a second time, and after each of six changes, "
      "with what the first two have cached: a body 10 K warmer, another visibility, field of view, position, material, half the accuracy's error. A process "
      "of its own for each state, and a cache of their own. A change that a scenario cannot have is left out, and said. Prints seconds by the clock and "
      "processor seconds of reading, planning, tables (all other preparing), programs (made, lines, and files that the driver's cache gained: 0 where it "
      "compiled nothing) and the first frame of every camera; percentiles of the frames after it, drawn and read back one after the other, from the first "
      "again where the scenario has fewer (not with a gimbal); memory. Spectral images, probes, audits and files are left out.",
      joined({{"--states", "A,B", "these alone, besides 'first'", someOf(w->request.states, firstStateNames(), "state")},
              {"--out", "FOLDER", "also write first.csv, a line a state, with all figures", into(w->out)}},
             onceOptions(w->request.once)),
      "",
      [w](const Arguments& words) { return first(*w, words); }};
}

}  // namespace pitviper
