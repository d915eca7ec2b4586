// What sim/model/field_drift.hpp promises of steps along a line, in closed form.
#include <gtest/gtest.h>

#include <vector>

#include "sim/model/field_drift.hpp"

namespace pitviper::test {
namespace {

/// Steps between places, each at the temperature of its middle.
template <class Temperature>
std::vector<FieldStep> stepsBetween(const std::vector<double>& places, const Temperature& temperature) {
  std::vector<FieldStep> steps;
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    FieldStep s;
    s.enter_m = places[k], s.leave_m = places[k + 1];
    s.temperature_K = temperature(0.5 * (places[k] + places[k + 1]));
    steps.push_back(s);
  }
  return steps;
}

// Rationale: 1 / T that rises evenly with the way is told exactly, however uneven steps are; ends have a neighbour on one side only.
TEST(FieldDrift, IsExactWhereTheInverseIsAStraightLine) {
  const double slope = 2e-4;
  auto steps = stepsBetween({1.0, 1.5, 3.0, 3.1, 7.0, 7.5}, [&](double x) { return 1.0 / (1e-3 + slope * x); });
  setDrifts(steps);
  EXPECT_EQ(steps.front().drift_perK, 0.0);
  EXPECT_EQ(steps.back().drift_perK, 0.0);
  for (std::size_t k = 1; k + 1 < steps.size(); ++k) EXPECT_NEAR(steps[k].drift_perK / (slope * (steps[k].leave_m - steps[k].enter_m)), 1.0, 1e-12) << k;
}

// Rationale: the hottest step has no slope that both its sides know; a step beside a gap has no neighbour there.
TEST(FieldDrift, IsNoneAtAnExtremumAndBesideAGap) {
  auto peak = stepsBetween({0.0, 1.0, 2.0, 3.0}, [](double x) { return x < 1.0 ? 400.0 : x < 2.0 ? 900.0 : 500.0; });
  setDrifts(peak);
  EXPECT_EQ(peak[1].drift_perK, 0.0);
  auto gap = stepsBetween({0.0, 1.0, 2.0, 3.0, 4.0}, [](double x) { return 300.0 + 100.0 * x; });
  gap[3].enter_m += 0.5;
  setDrifts(gap);
  EXPECT_LT(gap[1].drift_perK, 0.0);
  EXPECT_EQ(gap[2].drift_perK, 0.0);
}

}  // namespace
}  // namespace pitviper::test
