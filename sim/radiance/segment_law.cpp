#include "sim/radiance/segment_law.hpp"

#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/wide_loops.hpp"

namespace pitviper {
namespace {

PITVIPER_WIDE void weights(const SegmentAt at, int count, double* __restrict air, double* __restrict lost, double* __restrict growth, double* __restrict reach,
                           double* __restrict each) {
  for (int i = 0; i < count; ++i) {
    air[i] = physics::max(at.farDepth[i] - at.nearDepth[i], 0.0);
    const double d = air[i] + at.depth[i];
    const bool seen = (d > 0.0) & (at.nearDepth[i] + at.before[i] <= at.opaque);
    // Numbers that can be divided by, where nothing is seen too.
    const double near = at.nearPassed[i], depth = seen ? d : 1.0, left = at.farPassed[i] / (seen ? near : 1.0) * at.passed[i];
    lost[i] = physics::lostOf(depth, left);
    growth[i] = physics::growthOf(depth, left, lost[i]);
    reach[i] = seen ? at.panes[i] * at.beforePassed[i] : 0.0;
    each[i] = reach[i] * near / depth;
  }
}

PITVIPER_WIDE void media(const double* lost, const double* growth, const double* each, const double* emitted, const double* drifting, int count,
                         double* __restrict into) {
  for (int i = 0; i < count; ++i) into[i] += each[i] * (emitted[i] * lost[i] + drifting[i] * (growth[i] - 0.5 * lost[i]));
}

PITVIPER_WIDE void airOf(const double* air, const double* lost, const double* growth, const double* each, const double* near, const double* far,
                         const double* everywhere, int count, double* __restrict into) {
  for (int i = 0; i < count; ++i) into[i] += each[i] * air[i] * ((near[i] + everywhere[i]) * lost[i] + (far[i] - near[i]) * growth[i]);
}

PITVIPER_WIDE void sunOf(const SegmentLaw::SunAt sun, const double* depth, const double* passed, const double* reach, double scale, int count,
                         double* __restrict into) {
  for (int i = 0; i < count; ++i) {
    const double mean = physics::meanPassed(sun.nearDepth[i], sun.farDepth[i] + depth[i], sun.nearPassed[i], sun.farPassed[i] * passed[i]);
    into[i] += reach[i] > 0.0 ? scale * reach[i] * mean * sun.irradiance[i] * sun.turned[i] : 0.0;  // the way to the sun may be endless
  }
}

}  // namespace

void SegmentLaw::set(const SegmentAt& at, std::size_t count) {
  at_ = at;
  count_ = count;
  for (auto* v : {&air_, &lost_, &growth_, &reach_, &each_}) v->resize(count);
  weights(at, static_cast<int>(count), air_.data(), lost_.data(), growth_.data(), reach_.data(), each_.data());
}

void SegmentLaw::addMedia(const double* emitted, const double* drifting, double* into) const {
  media(lost_.data(), growth_.data(), each_.data(), emitted, drifting, static_cast<int>(count_), into);
}

void SegmentLaw::addAir(const double* near, const double* far, const double* everywhere, double* into) const {
  airOf(air_.data(), lost_.data(), growth_.data(), each_.data(), near, far, everywhere, static_cast<int>(count_), into);
}

void SegmentLaw::addSun(double scale, const SunAt& sun, double* into) const {
  sunOf(sun, at_.depth, at_.passed, reach_.data(), scale, static_cast<int>(count_), into);
}

}  // namespace pitviper
