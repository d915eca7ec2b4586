// Speed of this machine: one factor at a time, beside a fixed yardstick timed in the same rounds, because machines drift.
#include <algorithm>
#include <cstdio>

#include "scenarios/commands/accuracy_report.hpp"
#include "scenarios/commands/bench_report.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/first_command.hpp"
#include "scenarios/commands/guard_bench.hpp"
#include "scenarios/commands/options.hpp"
#include "scenarios/commands/phong_bench.hpp"
#include "scenarios/commands/scenario_bench.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {
namespace {

int framesWanted(const Options& o) {
  const auto [frames, last] = readRange(o.value("--frames", "60"), "--frames");
  if (frames != last || frames < 10 || frames > 100000)
    throw UserError({"--frames " + o.value("--frames"), 0, 0, -1}, "not a number of frames to time", "10 to 100000", "write --frames 60");
  return static_cast<int>(frames);
}

std::vector<BenchFactor> factorsWanted(const Options& o) {
  std::vector<BenchFactor> all = benchFactors();
  if (!o.has("--factor")) return all;
  const std::string wanted = o.value("--factor");
  std::vector<std::string> names;
  for (const auto& f : all) names.push_back(f.name);
  std::erase_if(all, [&](const BenchFactor& f) { return f.name != wanted; });
  if (all.empty())
    throw UserError({"--factor " + wanted, 0, 0, -1}, "there is no such factor", "one of " + listed(names),
                    didYouMean(wanted, names, "choose one, or leave --factor out"));
  return all;
}

/// A whole number of an option within bounds, or what it is without.
int wholeNumber(const Options& o, const std::string& name, int otherwise, int least, int most, const std::string& meaning) {
  if (!o.has(name)) return otherwise;
  const auto [n, last] = readRange(o.value(name), name);
  if (n != last || n < least || n > most)
    throw UserError({name + " " + o.value(name), 0, 0, -1}, "not " + meaning, std::to_string(least) + " to " + std::to_string(most),
                    "write " + name + " " + std::to_string(otherwise > 0 ? otherwise : least));
  return static_cast<int>(n);
}

int accuracyCommand(const Options& o) {
  if (o.has("--factor")) throw UserError({"pitviper bench", 0, 0, -1}, "--factor says nothing to --accuracy", "one of the two", "remove one");
  AccuracyRequest request;
  request.scenario = o.value("--accuracy");
  request.changes = o.values("--set");
  request.roots = rootsOf(o);
  request.size_px = wholeNumber(o, "--size", 0, 8, 4096, "a number of columns");
  request.frames = wholeNumber(o, "--frames", 3, 1, 1000, "a number of frames to compare");
  const std::filesystem::path out = o.value("--out");
  if (o.has("--out")) ensureWritableFolder(out);
  const GlContext context;
  const AccuracyReport report = measureAccuracy(request);
  std::printf("%s\n%s\n%s", report.heading.c_str(), context.limits().renderer.c_str(), accuracyTables(report).c_str());
  if (!o.has("--out")) return 0;
  writeFileAtomically(out / "accuracy.csv", accuracyCsv(report));
  std::printf("\n%s written\n", (out / "accuracy.csv").string().c_str());
  const auto charts = accuracyCharts(report);
  drawCharts(charts, std::min(static_cast<int>(charts.size()), 4), out / "accuracy.png");
  std::printf("%s written\n", (out / "accuracy.png").string().c_str());
  return 0;
}

int scenarioCommand(const Options& o) {
  for (const char* other : {"--factor", "--out"})
    if (o.has(other)) throw UserError({"pitviper bench", 0, 0, -1}, std::string(other) + " says nothing to --scenario", "one of the two", "remove one");
  const GlContext context;
  const auto rates = timeScenario(o.value("--scenario"), o.values("--set"), rootsOf(o), framesWanted(o));
  std::printf("%s\n%s", context.limits().renderer.c_str(), rateTable(rates).c_str());
  return 0;
}

/// Those with options of their own.
constexpr std::pair<const char*, int (*)(const Arguments&)> kOwnBenches[] = {{"--first", firstCommand}, {"--once", onceCommand}, {"--guard", guardCommand}};

}  // namespace

int benchCommand(const Arguments& arguments) {
  for (const auto& [option, command] : kOwnBenches)
    if (const auto found = std::find(arguments.begin(), arguments.end(), option); found != arguments.end()) {
      Arguments others(arguments);
      others.erase(others.begin() + (found - arguments.begin()));
      return command(others);
    }
  const Options o("bench", arguments,
                  {{"--frames"}, {"--factor"}, {"--out"}, {"--accuracy"}, {"--scenario"}, {"--size"}, {"--set", true, true}, rootOption(), {"--phong", false}}, 0, 0);
  if (o.has("--phong")) {
    if (arguments.size() > 1) throw UserError({"pitviper bench", 0, 0, -1}, "--phong with other options", "it alone", "remove them");
    std::printf("%s", phongBench().c_str());
    return 0;
  }
  if (o.has("--accuracy")) return accuracyCommand(o);
  if (o.has("--size")) throw UserError({"pitviper bench", 0, 0, -1}, "--size goes with --accuracy", "a scenario", "remove it, or add --accuracy");
  if (o.has("--scenario")) return scenarioCommand(o);
  if (o.has("--set")) throw UserError({"pitviper bench", 0, 0, -1}, "--set goes with --accuracy or --scenario", "a scenario", "remove it, or add one");
  if (o.has("--root")) throw UserError({"pitviper bench", 0, 0, -1}, "--root goes with --accuracy or --scenario", "a scenario", "remove it, or add one");
  const int frames = framesWanted(o);
  std::vector<BenchFactor> factors = factorsWanted(o);
  const std::filesystem::path out = o.value("--out");
  if (o.has("--out")) ensureWritableFolder(out);

  const GlContext context;
  for (BenchFactor& f : factors) dropWhatIsNotOffered(f);
  Yardstick yardstick;
  int steps = 0;
  for (const auto& f : factors) steps += benchSteps(f, frames);
  Progress progress("bench", steps);
  std::vector<BenchRow> rows;
  for (const auto& f : factors) {
    const auto timed = timeFactor(f, frames, yardstick, progress);
    rows.insert(rows.end(), timed.begin(), timed.end());
  }
  progress.finish();

  std::printf(
      "%s\nCentre: 256x256 pixels, 16 channels, 16 wavelengths, one light, thermal emission, air on both legs; one factor varied at a time.\n"
      "Medians of up to %d frames, each row in turn with the yardstick, a bare 16-wavelength loop.\n\n%s",
      context.limits().renderer.c_str(), frames, benchTables(factors, rows).c_str());
  if (!o.has("--out")) return 0;
  writeFileAtomically(out / "bench.csv", benchCsv(rows));
  std::printf("\n%s written\n", (out / "bench.csv").string().c_str());
  drawCharts(benchCharts(factors, rows), 3, out / "bench.png");
  std::printf("%s written\n", (out / "bench.png").string().c_str());
  return 0;
}

}  // namespace pitviper
