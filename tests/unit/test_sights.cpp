// Lines through fields as a plan's fits are taught them: fewer steps, nothing lost.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/plan/sights.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

std::vector<Slab> steps(int field, int count, double from_m) {
  std::vector<Slab> all;
  for (int k = 0; k < count; ++k) {
    FieldStep s;
    s.enter_m = from_m + k, s.leave_m = from_m + k + 1.0;
    s.amount[0] = 1.0 + 0.5 * std::sin(0.3 * k), s.amount[1] = k < count / 2 ? 0.0 : 2.0 + k;
    s.temperature_K = 400.0 + 10.0 * k;
    s.drift_perK = 1e-6 * k;
    all.push_back({field, s});
  }
  return all;
}

TEST(FieldsInParts, NothingIsLost) {
  for (const int count : {1, 8, 9, 48, 301}) {
    std::vector<Slab> all = steps(0, count, 100.0);
    const std::vector<Slab> other = steps(1, 5, 120.0);
    all.insert(all.end(), other.begin(), other.end());
    const std::vector<Slab> some = inParts(all);
    int first = 0;
    double before_m = 0.0;
    std::array<double, 3> lost{};  // of two gases and of drifts
    for (const Slab& s : all) lost[0] += s.step.amount[0], lost[1] += s.step.amount[1], lost[2] += s.step.drift_perK;
    for (const Slab& s : some) {
      first += s.field == 0;
      lost[0] -= s.step.amount[0], lost[1] -= s.step.amount[1], lost[2] -= s.step.drift_perK;
      if (s.field == 0) {
        EXPECT_GE(s.step.enter_m, before_m);
        before_m = s.step.leave_m;
      }
      EXPECT_GE(s.step.temperature_K, 400.0);
      EXPECT_LE(s.step.temperature_K, 400.0 + 10.0 * count + 50.0);
    }
    EXPECT_LE(first, static_cast<int>(kFieldParts));
    EXPECT_LE(first, count);
    EXPECT_EQ(static_cast<int>(some.size()) - first, 5) << "few steps stay, and fields stay apart";
    EXPECT_EQ(some.front().step.enter_m, 100.0);
    EXPECT_EQ(before_m, 100.0 + count);
    for (double l : lost) EXPECT_NEAR(l, 0.0, 1e-9) << "sums of hundreds of numbers of tens, in double";
  }
}

}  // namespace
}  // namespace pitviper::test
