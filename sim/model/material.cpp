#include "sim/model/material.hpp"

#include <algorithm>

namespace pitviper {

double GivenEmissivity::at(double wavelength_um, double angle) const {
  const double eps = emissivity(wavelength_um);
  if (viewAngle_rad.empty()) return eps;
  if (angle <= viewAngle_rad.front()) return eps * factor.front();
  if (angle >= viewAngle_rad.back()) return eps * factor.back();
  const auto above = std::upper_bound(viewAngle_rad.begin(), viewAngle_rad.end(), angle);
  const size_t i = static_cast<size_t>(above - viewAngle_rad.begin()) - 1;
  const double f = (angle - viewAngle_rad[i]) / (viewAngle_rad[i + 1] - viewAngle_rad[i]);
  return eps * (factor[i] + f * (factor[i + 1] - factor[i]));
}

double Material::reflectance(double wavelength_um, double angle) const {
  double sum = 0.0;
  for (const auto& r : reflections) sum += r->hemispherical(wavelength_um, angle);
  return sum;
}

double Material::emissivity(double wavelength_um, double angle) const {
  return given ? given->at(wavelength_um, angle) : 1.0 - reflectance(wavelength_um, angle);
}

bool Material::needsAngles() const {
  if (given && !given->viewAngle_rad.empty()) return true;
  return std::any_of(reflections.begin(), reflections.end(), [](const auto& r) {
    return r->axes()[0].angle != Angle::None || r->hemisphericalVaries();
  });
}

bool Material::hasModifiers() const {
  return std::any_of(modifiers.begin(), modifiers.end(), [](int m) { return m >= 0; }) || (given && given->modifier >= 0);
}

double Material::validLow_um() const {
  double low = given ? given->emissivity.validLow() : kShortestWavelength_um;
  for (const auto& r : reflections) low = std::max(low, r->validLow_um());
  return low;
}
double Material::validHigh_um() const {
  double high = given ? given->emissivity.validHigh() : kLongestWavelength_um;
  for (const auto& r : reflections) high = std::min(high, r->validHigh_um());
  return high;
}

}  // namespace pitviper
