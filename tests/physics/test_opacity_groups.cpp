// Opacity groups on scenes: how few hold a tolerance on products that were not planned with, against samples and bins without planning.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/physics/group_scene.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/long_tests.hpp"

namespace pitviper::test {
namespace {

constexpr int kFresh = 10000;

struct Baselines {
  int samples = 0, bins = 0;  ///< fewest of a rising row of counts within the tolerance; kNone: not even the last
};
constexpr int kNone = 999;

Baselines baselines(const SpectralProblem& fresh, double tolerance) {
  const EvenBins bins(fresh);
  Baselines b{kNone, kNone};
  // Counts that grow by an eighth: the baseline is told to within that.
  for (int n = 8; n < 500 && (b.samples == kNone || b.bins == kNone); n += std::max(n / 8, 1)) {
    if (b.samples == kNone && evenSamplesError(fresh, n) <= tolerance) b.samples = n;
    if (b.bins == kNone && bins.error(n) <= tolerance) b.bins = n;
  }
  return b;
}

/// The fewest groups, in steps, that hold a tolerance on products not planned with.
struct Chosen {
  GroupFit fit;
  double error = 0.0;  ///< the largest on those products
};

Chosen choose(const SpectralProblem& train, const SpectralProblem& unseen, double tolerance, int atLeast, int most, int step) {
  const FitEffort effort{60, 500, 0.0};
  Chosen c;
  for (int n = atLeast; n <= most; n += step) {
    c.fit = fitGroups(train, n, effort);
    c.error = evaluateGroups(unseen, c.fit.groups).maximum;
    if (c.error <= tolerance) break;
  }
  return c;
}

struct Expected {
  SceneBand band;
  double tolerance;
  int atLeast, atMost, step;  ///< where the search begins, a step below what holds at present, and must have ended
  double timesFewer;          ///< than the better of samples and bins, or than samples where bins need a table of every path
};

class OpacityGroupsOnScenes : public ::testing::TestWithParam<Expected> {};

// Rationale: temperatures, ranges, heights, angles and mixtures of surfaces of the fresh products are others than those planned with. Expected:
// the tolerance holds on a second fresh set that no choice was made with; the largest of 10000 errors scatters, so it may be twice that,
// while the 99th percentile keeps it.
TEST_P(OpacityGroupsOnScenes, FewHoldWhatManySamplesDo) {
  const Expected& e = GetParam();
  if (e.tolerance < 0.005 && e.band != SceneBand::Midwave && !runsLong())
    GTEST_SKIP() << "the claim of 1 % in this band and of 0.1 % in another; PITVIPER_LONG=1 runs it";
  const GroupScene& scene = groupScene(e.band);
  const SpectralProblem train = drawProblem(scene, {1, 10000, false}), chosenWith = drawProblem(scene, {2, kFresh, true}),
                        fresh = drawProblem(scene, {3, kFresh, true});
  const std::string what = scene.name + (e.tolerance > 0.005 ? ", 1 %: " : ", 0.1 %: ");
  const Chosen c = choose(train, chosenWith, e.tolerance, e.atLeast, e.atMost, e.step);
  EXPECT_LE(c.error, e.tolerance) << what;
  const GroupFit seen = evaluateGroups(fresh, c.fit.groups);
  const Baselines b = baselines(fresh, e.tolerance);
  const auto groups = static_cast<double>(c.fit.groups.size());
  bound(what + "groups", groups, e.atMost, "fewest that hold it on 10000 unseen products; 10000 others planned with");
  bound(what + "largest error of another 10000", seen.maximum, 2.0 * e.tolerance, "not chosen with");
  bound(what + "99th percentile of their errors", seen.p99, e.tolerance, "not chosen with");
  bound(what + "even samples would be", b.samples, kNone, "wavelengths in the middle of even bins (999: more than 500)");
  bound(what + "even bins would be", b.bins, kNone, "exact transmittance of every path in each bin, of air and of each gas (999: more than 500)");
  EXPECT_GE(b.samples, e.timesFewer * groups) << what;
}

INSTANTIATE_TEST_SUITE_P(Bands, OpacityGroupsOnScenes,
                         ::testing::Values(Expected{SceneBand::Midwave, 0.01, 10, 12, 1, 4.0}, Expected{SceneBand::MidwavePlume, 0.01, 48, 60, 6, 8.0},
                                           Expected{SceneBand::Longwave, 0.01, 4, 9, 1, 4.0}, Expected{SceneBand::Shortwave, 0.01, 4, 8, 1, 8.0},
                                           Expected{SceneBand::Midwave, 0.001, 28, 36, 4, 8.0}, Expected{SceneBand::Longwave, 0.001, 20, 48, 4, 2.0},
                                           Expected{SceneBand::Shortwave, 0.001, 16, 28, 4, 8.0}),
                         [](const auto& row) {
                           return "Band" + std::to_string(static_cast<int>(row.param.band)) + (row.param.tolerance > 0.005 ? "Percent" : "PerMille");
                         });

}  // namespace
}  // namespace pitviper::test
