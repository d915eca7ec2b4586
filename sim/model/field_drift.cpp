#include "sim/model/field_drift.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// Steps touch where the end of one is the beginning of the other, but for rounding; several of one stretch do not.
constexpr double kTouch = 1e-6;

bool touch(const FieldStep& nearer, const FieldStep& farther) {
  return std::abs(farther.enter_m - nearer.leave_m) <= kTouch * (farther.leave_m - nearer.enter_m) && nearer.temperature_K > 0.0 && farther.temperature_K > 0.0;
}

}  // namespace

double driftOf(double nearer, double nearerLength, double own, double length, double farther, double fartherLength) {
  const double near = (own - nearer) * length / (length + nearerLength), far = (farther - own) * length / (length + fartherLength);
  return near * far > 0.0 ? std::copysign(2.0 * std::min(std::abs(near), std::abs(far)), near) : 0.0;
}

void setDrifts(std::span<FieldStep> steps) {
  for (std::size_t k = 0; k < steps.size(); ++k) {
    FieldStep& s = steps[k];
    s.drift_perK = 0.0;
    if (k == 0 || k + 1 == steps.size() || !touch(steps[k - 1], s) || !touch(s, steps[k + 1])) continue;
    const FieldStep &before = steps[k - 1], &after = steps[k + 1];
    s.drift_perK = driftOf(1.0 / before.temperature_K, before.leave_m - before.enter_m, 1.0 / s.temperature_K, s.leave_m - s.enter_m, 1.0 / after.temperature_K,
                           after.leave_m - after.enter_m);
  }
}

}  // namespace pitviper
