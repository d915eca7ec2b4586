#include "tests/support/cloud_photons.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

glm::dvec3 turned(const glm::dvec3& d, double cosine, double azimuth) {
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const glm::dvec3 helper = std::abs(d.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0), u = glm::normalize(glm::cross(d, helper)),
                   v = glm::cross(d, u);
  return glm::normalize(d * cosine + u * (sine * std::cos(azimuth)) + v * (sine * std::sin(azimuth)));
}

double cosineOf(double g, double random) {
  const double q = (1.0 - g * g) / (1.0 - g + 2.0 * g * random);
  return std::clamp((1.0 + g * g - q * q) / (2.0 * g), -1.0, 1.0);
}

/// How far the next collision is; below 0: it leaves.
double collision(const DensityGrid& grid, double majorant, const glm::dvec3& p, const glm::dvec3& d, WalkDice& dice) {
  const glm::dvec2 chord = grid.chord(p, d);
  for (double t = chord.x; chord.y > chord.x;) {
    t -= std::log(1.0 - unitOf(dice)) / majorant;
    if (t >= chord.y) break;
    if (unitOf(dice) * majorant < grid.at(p + d * t)) return t;
  }
  return -1.0;
}

}  // namespace

std::vector<CloudParts> cloudLight(const CloudPhotons& cloud, const glm::dvec3& eye, const glm::dvec3& direction, int ways, WalkDice& dice) {
  const double majorant = *std::max_element(cloud.extinction.value.begin(), cloud.extinction.value.end());
  const std::size_t count = cloud.albedos.size();
  std::vector<CloudParts> sum(count);
  std::vector<double> weight(count);
  for (int n = 0; n < ways; ++n) {
    std::fill(weight.begin(), weight.end(), 1.0 / ways);
    glm::dvec3 p = eye, d = direction;
    for (;;) {
      const double t = collision(cloud.extinction, majorant, p, d, dice);
      if (t < 0.0) {
        for (std::size_t w = 0; w < count; ++w) (d.z >= 0.0 ? sum[w].sky : sum[w].ground) += weight[w];
        break;
      }
      p += d * t;
      const bool lit = collision(cloud.extinction, majorant, p, cloud.toSun, dice) < 0.0;
      const double phase = physics::henyeyGreensteinPhase(glm::dot(d, cloud.toSun), cloud.asymmetry);
      for (std::size_t w = 0; w < count; ++w) {
        sum[w].drops += weight[w] * (1.0 - cloud.albedos[w]);
        weight[w] *= cloud.albedos[w];
        if (lit) sum[w].sun += weight[w] * phase;
      }
      const double bend = cosineOf(cloud.asymmetry, unitOf(dice)), azimuth = 2.0 * kPi * unitOf(dice);
      d = turned(d, bend, azimuth);
    }
  }
  return sum;
}

}  // namespace pitviper
