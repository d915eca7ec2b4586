#include "scenarios/commands/first_command.hpp"

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "scenarios/commands/first_once.hpp"
#include "scenarios/commands/first_report.hpp"
#include "scenarios/commands/process.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/table.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

constexpr int kMostFrames = 100000;

int framesOf(const Options& o) {
  const auto [n, last] = readRange(o.value("--frames", "100"), "--frames");
  if (n != last || n < 0 || n > kMostFrames)
    throw UserError({"--frames " + o.value("--frames"), 0, 0, -1}, "not a number of frames after the first", "0 to " + std::to_string(kMostFrames), "write --frames 100");
  return static_cast<int>(n);
}

double secondsOf(const Options& o) {
  const auto written = splitQuantity(o.value("--seconds", "20"));
  if (!written || !(written->unit.empty() || written->unit == "s") || !(written->value >= 0.0))
    throw UserError({"--seconds " + o.value("--seconds"), 0, 0, -1}, "not a time that frames may take", "seconds, 0 or more", "write --seconds 20");
  return written->value;
}

/// "a,b" as names of states; without, all of them.
std::vector<std::string> statesOf(const Options& o) {
  const std::vector<std::string> all = firstStateNames();
  if (!o.has("--states")) return all;
  std::vector<std::string> wanted;
  std::istringstream in(o.value("--states"));
  for (std::string name; std::getline(in, name, ',');) {
    if (std::find(all.begin(), all.end(), name) == all.end())
      throw UserError({"--states " + o.value("--states"), 0, 0, -1}, "there is no state '" + name + "'", "some of " + listed(all) + ", between commas", didYouMean(name, all));
    wanted.push_back(name);
  }
  std::vector<std::string> ordered{"first"};
  for (const std::string& name : all)
    if (name != "first" && std::find(wanted.begin(), wanted.end(), name) != wanted.end()) ordered.push_back(name);
  return ordered;
}

std::vector<std::string> shippedScenarios() {
  const std::filesystem::path folder = findLibraries().materials.parent_path().parent_path() / "scenarios";
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".yaml") all.push_back(entry.path().string());
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

int onceCommand(const Arguments& arguments) {
  const Options o("bench", arguments, {{"--frames"}, {"--seconds"}, {"--set", true, true}, rootOption()}, 1, 1);
  std::fputs(writeFigures(measureOnce({o.words()[0], o.values("--set"), rootsOf(o), framesOf(o), secondsOf(o)})).c_str(), stdout);
  return 0;
}

int firstCommand(const Arguments& arguments) {
  const Options o("bench", arguments, {{"--frames"}, {"--seconds"}, {"--states"}, {"--out"}, {"--set", true, true}, rootOption()}, 0, 1000);
  const std::vector<std::string> states = statesOf(o), scenarios = o.words().empty() ? shippedScenarios() : o.words();
  const int frames = framesOf(o);
  const double frames_s = secondsOf(o);
  const std::filesystem::path out = o.value("--out");
  if (o.has("--out")) ensureWritableFolder(out);
  std::vector<FirstRow> rows;
  int code = 0;
  for (const std::string& scenario : scenarios) {
    Progress progress("bench", static_cast<int>(states.size()));
    bool begun = false;
    try {
      rows.push_back({scenario, measureFirst({scenario, o.values("--set"), rootsOf(o), states, frames, frames_s}, [&](const std::string& state) {
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
    if (o.has("--out")) writeFileAtomically(out / "first.csv", firstCsv(rows));  // after each: what ends it takes nothing that was measured
  }
  if (rows.size() > 1) std::printf("%s\n", firstSummary(rows, states).c_str());
  if (o.has("--out") && !rows.empty()) std::printf("%s written\n", (out / "first.csv").string().c_str());
  return code;
}

}  // namespace pitviper
