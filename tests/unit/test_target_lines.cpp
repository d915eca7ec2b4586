// A few lines of sight that stand for all of a target's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "sim/frame/target_lines.hpp"

namespace pitviper::test {
namespace {

/// Lines of two kinds of things: the first's contrast grows from -1 to 3, the second's is 40 times as strong over a tenth of the solid angle.
std::vector<TargetLine> lines() {
  std::vector<TargetLine> all;
  for (int k = 0; k < 1000; ++k) all.push_back({7, {k, 0.0}, 1e-6, {-1.0 + 0.004 * k, 1.0}});
  for (int k = 0; k < 100; ++k) all.push_back({5, {k, 1.0}, 1e-6, {40.0, 40.0}});
  return all;
}

TEST(TargetLines, StrataHaveThemAll) {
  const std::vector<TargetLine> all = lines();
  for (int shares : {1, 8, 64}) {
    const std::vector<Stratum> strata = strataOf(all, shares);
    EXPECT_GE(strata.size(), 2u);
    EXPECT_LE(strata.size(), static_cast<size_t>(shares) + 2);
    double sr = 0.0, contrast = 0.0, want = 0.0;
    std::set<std::size_t> things;
    for (const Stratum& s : strata) sr += s.sr, contrast += s.contrast[0], things.insert(s.line->things);
    for (const TargetLine& l : all) want += l.sr * l.contrast[0];
    EXPECT_NEAR(sr, 1100e-6, 1e-12);
    EXPECT_NEAR(contrast, want, 1e-9 * std::abs(want));
    EXPECT_EQ(things, (std::set<std::size_t>{5, 7}));
  }
}

TEST(TargetLines, StrataHaveAsMuchContrastEachAndALineFromTheirMiddle) {
  std::vector<TargetLine> all;
  for (int k = 0; k < 4000; ++k) all.push_back({1, {k, 0.0}, 1e-6, {0.001 * k}});
  const std::vector<Stratum> strata = strataOf(all, 4);
  ASSERT_EQ(strata.size(), 4u);
  for (size_t s = 0; s < strata.size(); ++s) {
    // Contrast grows as k: a share of it up to k is (k / 4000)^2.
    EXPECT_NEAR(strata[s].contrast[0], 0.25 * 0.5 * 4.0 * 4000e-6, 1e-5);
    EXPECT_NEAR(strata[s].line->at.x, 4000.0 * std::sqrt((static_cast<double>(s) + 0.5) / 4.0), 2.0);
  }
}

TEST(TargetLines, ManyKindsOfThingsAreFewStrata) {
  std::vector<TargetLine> all;
  for (std::size_t k = 0; k < 1000; ++k) all.push_back({k, {k, 0.0}, 1e-6, {1.0 + 1e-3 * static_cast<double>(k)}});
  all.push_back({5000, {-1.0, 0.0}, 1e-6, {1000.0}});
  const std::vector<Stratum> strata = strataOf(all, 8);
  EXPECT_LE(strata.size(), 41u);
  double sr = 0.0;
  for (const Stratum& s : strata) sr += s.sr;
  EXPECT_NEAR(sr, 1001e-6, 1e-12) << "none is left out";
  EXPECT_TRUE(std::any_of(strata.begin(), strata.end(), [](const Stratum& s) { return s.line->things == 5000 && s.sr < 2e-6; })) << "what is much is by itself";
}

TEST(TargetLines, NothingHasNoStrata) {
  EXPECT_TRUE(strataOf({}, 8).empty());
  EXPECT_TRUE(strataOf({{1, {}, 1e-6, {0.0}}}, 8).empty()) << "no contrast, nothing to lose";
}

}  // namespace
}  // namespace pitviper::test
