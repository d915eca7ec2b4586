// Speed of this machine: one factor at a time, beside a fixed yardstick timed in the same rounds, because machines drift.
#include <cstdio>

#include "scenarios/commands/bench_report.hpp"
#include "scenarios/commands/commands.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/atomic_file.hpp"

namespace pitviper {
namespace {

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
  std::printf("\n");
  writeWithCharts(out, "bench", benchCsv(rows), benchCharts(factors, rows), 3);
  return 0;
}

}  // namespace

CommandLine benchCommand() {
  const auto w = std::make_shared<BenchWish>();
  std::vector<Word<std::vector<BenchFactor>>> names;
  for (const BenchFactor& f : w->factors) names.push_back({f.name, {f}});
  return {{"bench", "", "speed of this machine beside a fixed yardstick"},
          "Times direct and buffered mode on a wall that fills the film (256x256, 16 channels, 16 wavelengths, one light, thermal emission, air on both legs), "
          "then with one factor varied at a time, in rounds that alternate with a bare loop over 16 wavelengths, the yardstick. Prints tables: milliseconds, "
          "million pixels and frames a second, speed by the yardstick, time by the centre. Takes some minutes.",
          {{"--factor", "NAME", "this factor only", oneOf(w->factors, names)},
           {"--frames", "N", "frames to time in each row; fewer of slow ones", number(w->frames, {10, 100000, "", false, "not a number of frames to time"})},
           {"--out", "FOLDER", "also write bench.csv and a chart, bench.png (needs VTK), in FOLDER; created if missing", into(w->out)}},
          [w](const Arguments&) { return bench(*w); }};
}

}  // namespace pitviper
