#include "tests/support/photon_walk.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/atmosphere.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Ways that count for less than this go on with a chance of so much, and then count so much more.
constexpr double kSlight = 0.1;
/// No way is longer: in air that absorbs nothing over white ground a few take hundreds.
constexpr int kMostTurns = 2000;

/// A unit vector at an angle of this cosine to another, all around it.
glm::dvec3 turned(const glm::dvec3& d, double cosine, double azimuth) {
  const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
  const glm::dvec3 x = glm::normalize(glm::cross(std::abs(d.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0), d)), y = glm::cross(d, x);
  return glm::normalize(cosine * d + sine * (std::cos(azimuth) * x + std::sin(azimuth) * y));
}

}  // namespace

PhotonWalk::PhotonWalk(WalkAir air) : air_(std::move(air)) {}

std::size_t PhotonWalk::layerOf(double depthAbove) const {
  // Depths fall with height.
  const auto above = std::lower_bound(air_.above.begin(), air_.above.end(), depthAbove, [](double edge, double at) { return edge > at; });
  return std::clamp<std::size_t>(static_cast<std::size_t>(above - air_.above.begin()), 1, air_.above.size() - 1) - 1;
}

double PhotonWalk::sunAt(std::size_t layer, double depthAbove) const {
  const double low = air_.above[layer], high = air_.above[layer + 1], f = low > high ? std::clamp((low - depthAbove) / (low - high), 0.0, 1.0) : 0.0;
  return (1.0 - f) * air_.sunlight[layer] + f * air_.sunlight[layer + 1];
}

glm::dvec3 PhotonWalk::before(const glm::dvec3& direction, bool particles, double g, WalkDice& dice) {
  const double u = unitOf(dice), azimuth = 2.0 * kPi * unitOf(dice);
  double cosine = 2.0 * u - 1.0;
  if (!particles) {
    // 3/8 (1 + c^2) integrated: c^3 + 3 c = 8 u - 4.
    const double q = 4.0 * u - 2.0, root = std::cbrt(q + std::sqrt(q * q + 1.0));
    cosine = root - 1.0 / root;
  } else if (std::abs(g) > 1e-3) {
    const double s = (1.0 - g * g) / (1.0 + g * cosine);
    cosine = (1.0 + g * g - s * s) / (2.0 * g);
  }
  return turned(direction, std::clamp(cosine, -1.0, 1.0), azimuth);
}

glm::dvec3 PhotonWalk::evenlySent(const glm::dvec3& normal, WalkDice& dice) {
  const double cosine = std::sqrt(unitOf(dice)), azimuth = 2.0 * kPi * unitOf(dice);
  return turned(normal, cosine, azimuth);
}

PhotonWalk::Found PhotonWalk::from(double depthAbove, const glm::dvec3& towards, WalkDice& dice) const {
  Found found;
  const double bottom = air_.above.front();
  double depth = std::clamp(depthAbove, 0.0, bottom), weight = 1.0;
  glm::dvec3 d = towards;
  bool fresh = true;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    double passed = 0.0;
    if (d.z > 0.0) {
      const double out = depth / d.z, stays = -std::expm1(-out);
      if (!(stays > 0.0)) return found;
      weight *= stays;
      passed = -std::log1p(-unitOf(dice) * stays);
    } else {
      passed = -std::log1p(-unitOf(dice));
    }
    depth -= passed * d.z;
    if (depth >= bottom) {
      depth = bottom;
      const double sent = weight * air_.groundAlbedo / kPi * std::max(air_.toSun.z, 0.0) * air_.sunlight.front();
      (fresh ? found.ground : found.again) += sent;
      weight *= air_.groundAlbedo;
      d = evenlySent({0.0, 0.0, 1.0}, dice);
      d.z = std::max(d.z, 1e-9);
    } else {
      depth = std::max(depth, 0.0);
      const std::size_t layer = layerOf(depth);
      const double small = air_.molecules[layer], large = air_.haze[layer], cloud = air_.cloud.empty() ? 0.0 : air_.cloud[layer],
                   bend = air_.cloud.empty() ? 0.0 : air_.cloudAsymmetry[layer];
      const double cosine = glm::dot(d, air_.toSun), all = small + large + cloud;
      const double sent = weight * sunAt(layer, depth) *
                          (small * physics::rayleighPhase(cosine) + large * physics::henyeyGreensteinPhase(cosine, air_.asymmetry) +
                           cloud * physics::henyeyGreensteinPhase(cosine, bend));
      (fresh ? found.once : found.again) += sent;
      weight *= all;
      const double which = unitOf(dice) * all;
      d = before(d, which >= small, which >= small + large ? bend : air_.asymmetry, dice);
    }
    fresh = false;
    if (weight >= kSlight) continue;
    if (!(unitOf(dice) * kSlight < weight)) return found;
    weight = kSlight;
  }
  return found;
}

}  // namespace pitviper
