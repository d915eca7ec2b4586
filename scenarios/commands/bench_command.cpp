// Speed of this machine: one factor at a time, beside a fixed yardstick timed in the same rounds, because machines drift.
#include <algorithm>
#include <cstdio>

#include "scenarios/commands/accuracy_report.hpp"
#include "scenarios/commands/bench_report.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/phong_bench.hpp"
#include "scenarios/commands/scenario_bench.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/atomic_file.hpp"

namespace pitviper {
namespace {

/// To time.
Target framesToTime(int& frames) { return number(frames, {10, 100000, "", false, "not a number of frames to time"}); }

struct AccuracyWish {
  AccuracyRequest request;
  std::string out;
};

int benchAccuracy(const AccuracyWish& w) {
  const std::filesystem::path out = w.out;
  if (!out.empty()) ensureWritableFolder(out);
  const GlContext context;
  const AccuracyReport report = measureAccuracy(w.request);
  std::printf("%s\n%s\n%s", report.heading.c_str(), context.limits().renderer.c_str(), accuracyTables(report).c_str());
  if (out.empty()) return 0;
  writeFileAtomically(out / "accuracy.csv", accuracyCsv(report));
  std::printf("\n%s written\n", (out / "accuracy.csv").string().c_str());
  const auto charts = accuracyCharts(report);
  drawCharts(charts, std::min(static_cast<int>(charts.size()), 4), out / "accuracy.png");
  std::printf("%s written\n", (out / "accuracy.png").string().c_str());
  return 0;
}

struct BenchWish {
  std::vector<BenchFactor> factors = benchFactors();
  int frames = 60;
  std::string out;
};

int bench(BenchWish& w) {
  auto& [factors, frames, folder] = w;
  const std::filesystem::path out = folder;
  if (!out.empty()) ensureWritableFolder(out);

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
  if (out.empty()) return 0;
  writeFileAtomically(out / "bench.csv", benchCsv(rows));
  std::printf("\n%s written\n", (out / "bench.csv").string().c_str());
  drawCharts(benchCharts(factors, rows), 3, out / "bench.png");
  std::printf("%s written\n", (out / "bench.png").string().c_str());
  return 0;
}

}  // namespace

CommandLine benchCommand() {
  const auto w = std::make_shared<BenchWish>();
  std::vector<Word<std::vector<BenchFactor>>> names;
  for (const BenchFactor& f : w->factors) names.push_back({f.name, {f}});
  return {
      "bench",
      "",
      "speed of this machine beside a fixed yardstick",
      "Times direct and buffered mode on a wall that fills the film (256x256, 16 channels, 16 wavelengths, one light, thermal emission, air on both legs), "
      "then "
      "with one factor varied at a time, in rounds that alternate with a bare loop over 16 wavelengths, the yardstick. Prints tables: milliseconds, million "
      "pixels and frames a second, speed by the yardstick, time by the centre. Takes some minutes.",
      {{"--factor", "NAME", "this factor only", oneOf(w->factors, names)},
       {"--frames", "N", "frames to time in each row; fewer of slow ones", framesToTime(w->frames)},
       {"--out", "FOLDER", "also write bench.csv and a chart, bench.png (needs VTK), in FOLDER; created if missing", into(w->out)}},
      "",
      [w](const Arguments&) { return bench(*w); }};
}

CommandLine scenarioBenchCommand() {
  struct Wish {
    ScenarioWish scenario;
    int frames = 60;
  };
  const auto w = std::make_shared<Wish>();
  return {
      "bench --scenario",
      "SCENARIO.yaml",
      "",
      "Time of a frame of each camera, the frames in their order, drawing and readback, no files (with a gimbal its sensor and tracker too); beside them the "
      "yardstick, and where the time of a frame goes, part by part: what updates tables and shadow maps, what is seen, shading, readback and so on.",
      joined({{"--frames", "N", "frames to time", framesToTime(w->frames)}}, scenarioOptions(w->scenario)),
      "",
      [w](const Arguments& words) {
        w->scenario.file = words[0];
        const GlContext context;
        const auto rates = timeScenario(w->scenario, w->frames);
        std::printf("%s\n%s", context.limits().renderer.c_str(), rateTable(rates).c_str());
        return 0;
      }};
}

CommandLine accuracyBenchCommand() {
  const auto w = std::make_shared<AccuracyWish>();
  AccuracyRequest& r = w->request;
  return {
      "bench --accuracy",
      "SCENARIO.yaml",
      "",
      "The scenario's first camera at accuracies of 10 to 0.1 %, at 4 to 340 even samples and at 16 Gauss points a channel, against the reference (double "
      "precision on the CPU, every wavelength; slow). Prints frames a second and the error of each channel's pixels, |L - Lref| / max(Lref, 1e-3 x the 99th "
      "percentile of Lref), and as a temperature difference. The error is that of spectral sampling, tables, dropped terms and single precision; what a pixel "
      "sees is the same on both sides.",
      joined({{"--size", "N", "columns of the film, its field of view kept", number(r.size_px, {8, 4096, "", false, "not a number of columns"})},
              {"--frames", "N", "frames, spread over the scenario's time", number(r.frames, {1, 1000, "", false, "not a number of frames to compare"})},
              {"--out", "FOLDER", "also write accuracy.csv and a chart, accuracy.png (needs VTK)", into(w->out)}},
             scenarioOptions(r.scenario)),
      "",
      [w](const Arguments& words) { return w->request.scenario.file = words[0], benchAccuracy(*w); }};
}

CommandLine phongBenchCommand() {
  return {"bench --phong",
          "",
          "",
          "Tables of 200 entries of spectral Phong lobes against the formula, error and time, as in the paper that proposed them.",
          {},
          "",
          [](const Arguments&) {
            std::fputs(phongBench().c_str(), stdout);
            return 0;
          }};
}

}  // namespace pitviper
