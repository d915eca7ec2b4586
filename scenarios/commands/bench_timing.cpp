#include "scenarios/commands/bench_timing.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>

#include "scenarios/commands/bench_passes.hpp"

namespace pitviper {
namespace {

/// Many short rounds: what else runs on the machine spoils a few of them, and the median passes over those.
constexpr int kMostRounds = 20;
constexpr int kYardsticks = 2;  ///< before every row of every round
/// A row's share of a round: slow rows get fewer frames, the slowest sit out up to three rounds of four, and the whole bench stays below
/// two minutes on two cores.
constexpr double kTurn_s = 0.03;
constexpr int kMostStride = 4;

int roundsFor(int frames) { return std::clamp(frames, 1, kMostRounds); }

struct Timing {
  DrawFrame draw;
  int perRound = 1, stride = 1;  ///< frames in a round, every how many rounds
  std::vector<double> frames, bare;
  std::vector<double> frameOfRound, bareOfRound;  ///< medians; 0 where it sat out
};

}  // namespace

double timed(const std::function<void()>& draw) {
  glFinish();
  const auto start = std::chrono::steady_clock::now();
  draw();
  glFinish();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  const size_t half = v.size() / 2;
  return v.size() % 2 == 1 ? v[half] : 0.5 * (v[half - 1] + v[half]);
}

int benchSteps(const BenchFactor& factor, int frames) { return static_cast<int>(factor.variants.size()) * (roundsFor(frames) + 1); }

std::vector<BenchRow> timeFactor(const BenchFactor& factor, int frames, Yardstick& yardstick, Progress& progress) {
  const int rounds = roundsFor(frames);
  std::vector<Timing> timings(factor.variants.size());
  const auto drawBare = [&] { yardstick.draw(); };
  for (size_t i = 0; i < timings.size(); ++i) {
    const BenchVariant& v = factor.variants[i];
    Timing& t = timings[i];
    t.draw = v.whole ? prepareWholeFrame(v.setting) : preparePass(v.setting);
    timed(t.draw);  // the driver compiles
    const double once = timed(t.draw);
    t.perRound = std::clamp(static_cast<int>(kTurn_s / once), 1, std::max(1, frames / rounds));
    t.stride = std::clamp(static_cast<int>(once / kTurn_s), 1, kMostStride);
    t.frameOfRound.assign(static_cast<size_t>(rounds), 0.0);
    t.bareOfRound.assign(static_cast<size_t>(rounds), 0.0);
    progress.step();
  }
  timed(drawBare);
  for (int round = 0; round < rounds; ++round)
    for (size_t k = 0; k < timings.size(); ++k) {
      // Forth and back in turn: what drifts steadily within a round cancels between rows too.
      Timing& t = timings[round % 2 == 0 ? k : timings.size() - 1 - k];
      progress.step();
      if (round % t.stride != 0) continue;
      std::vector<double> bare, own;
      timed(drawBare);  // the row before left its own data in the caches
      for (int i = 0; i < kYardsticks; ++i) bare.push_back(timed(drawBare));
      if (t.stride == 1) timed(t.draw);
      for (int i = 0; i < t.perRound; ++i) own.push_back(timed(t.draw));
      t.bare.insert(t.bare.end(), bare.begin(), bare.end());
      t.frames.insert(t.frames.end(), own.begin(), own.end());
      t.bareOfRound[static_cast<size_t>(round)] = median(bare);
      t.frameOfRound[static_cast<size_t>(round)] = median(own);
    }

  std::vector<BenchRow> rows;
  for (size_t i = 0; i < timings.size(); ++i) {
    const Timing& t = timings[i];
    BenchRow row;
    row.factor = factor.name;
    row.variant = factor.variants[i];
    row.frames = static_cast<int>(t.frames.size());
    row.seconds = median(t.frames);
    row.yardstickSeconds = median(t.bare);
    const Timing& base = row.variant.base >= 0 ? timings[static_cast<size_t>(row.variant.base)] : t;
    std::vector<double> byYardstick, byBase;
    for (size_t r = 0; r < t.frameOfRound.size(); ++r) {
      if (t.frameOfRound[r] <= 0.0) continue;
      byYardstick.push_back(t.bareOfRound[r] / t.frameOfRound[r] * row.pixels() / (Yardstick::kSize_px * Yardstick::kSize_px));
      if (base.frameOfRound[r] > 0.0) byBase.push_back(t.frameOfRound[r] / base.frameOfRound[r]);
    }
    row.rateByYardstick = median(byYardstick);
    row.timeByBase = median(byBase);
    if (row.variant.added > 0) row.costPerLayer = (row.timeByBase - 1.0) / row.variant.added;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace pitviper
