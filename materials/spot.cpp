// A spot: a lamp whose intensity falls with a power of the cosine off its axis.
#include <cmath>

#include "materials/lights.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "materials/spot.glsl"
#undef PHYSICS
}  // namespace physics

LightModel spotModel() {
  // From a searchlight's divergence, which single precision holds to 2e-4 of the intensity, to nearly a half-space.
  constexpr double kNarrowest_rad = 0.1 * kPi / 180.0, kWidest_rad = 178.0 * kPi / 180.0;
  return {
      "spot",
      "A lamp with a beam (searchlight, headlight, illuminator): intensity falls as cos^n off its axis, and is 0 from 90 deg on.",
      {required(atLeast(spectrum("intensity", "W/(sr um)", "spectral radiant intensity on its axis"), 0)),
       required(within(number("beam_angle", "rad", "full angle between the directions of half the intensity on the axis: n = ln(1/2) / ln cos(beam_angle / 2)"),
                       kNarrowest_rad, kWidest_rad)),
       levelParameter()},
      [](const ModelRecord& r, PointLight& light) {
        light.intensity = r.spectrum("intensity");
        light.pattern = {
            "materials/spot.glsl", "spotPattern", physics::spotPattern, {-std::log(2.0) / std::log(std::cos(0.5 * r.record.number("beam_angle"))), 0, 0, 0}};
        readLevel(r.record, light);
      },
      true};
}

}  // namespace pitviper
