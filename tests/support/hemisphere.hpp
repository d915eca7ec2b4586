#pragma once
// Sums over the hemisphere that know nothing of what they are sums of.
#include <cmath>

#include "sim/model/material.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper::test {

/// integral f cos dw over light (or, `fromLight`, over views) by 320,000 directions alike in cos^2, for one other direction at an angle from the normal.
inline double bruteHemispherical(const Material& m, double wavelength_um, double angle_rad, bool fromLight = false) {
  constexpr int kElevations = 400, kAzimuths = 800;
  const glm::dvec3 fixed(std::sin(angle_rad), 0.0, std::cos(angle_rad));
  double sum = 0.0;
  for (int i = 0; i < kElevations; ++i)
    for (int k = 0; k < kAzimuths; ++k) {
      const double s2 = (i + 0.5) / kElevations, s = std::sqrt(s2), phi = 2.0 * kPi * (k + 0.5) / kAzimuths;
      const glm::dvec3 other(s * std::cos(phi), s * std::sin(phi), std::sqrt(1.0 - s2));
      for (const auto& r : m.reflections) sum += (fromLight ? r->brdf(wavelength_um, fixed, other) : r->brdf(wavelength_um, other, fixed));
    }
  return sum * kPi / (kElevations * kAzimuths);
}

/// The i-th of two unlike directions of the upper hemisphere, down to 1 deg above the horizon.
inline std::pair<glm::dvec3, glm::dvec3> directionPair(int i) {
  const auto direction = [](double a, double b) { return glm::normalize(glm::dvec3(std::cos(a) * b, std::sin(a) * b, 1.02 - b)); };
  return {direction(0.37 * i, 0.5 + 0.499 * std::sin(1.3 * i)), direction(1.91 * i, 0.5 + 0.499 * std::sin(2.7 * i))};
}

/// |f(l, v) - f(v, l)| over their sum, at most over components and `count` pairs.
inline double worstReciprocity(const Material& m, double wavelength_um, int count) {
  double worst = 0.0;
  for (const auto& r : m.reflections)
    for (int i = 0; i < count; ++i) {
      const auto [l, v] = directionPair(i);
      const double f = r->brdf(wavelength_um, l, v), g = r->brdf(wavelength_um, v, l);
      worst = std::max(worst, std::abs(f - g) / std::max(1e-6, f + g));
    }
  return worst;
}

}  // namespace pitviper::test
