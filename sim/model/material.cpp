#include "sim/model/material.hpp"

#include <algorithm>

#include "sim/model/atmosphere.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {

double Medium::source(double wavelength_um, double temperature_K, double gain) const {
  const double black = physics::planckRadiance(wavelength_um, temperature_K);
  return (albedo ? 1.0 - (*albedo)(wavelength_um) : 1.0) * black + (radiance ? gain * (*radiance)(wavelength_um) : 0.0);
}

double Medium::scattered(double wavelength_um, double cosScatter) const {
  return albedo ? (*albedo)(wavelength_um)*physics::henyeyGreensteinPhase(cosScatter, asymmetry ? (*asymmetry)(wavelength_um) : 0.0) : 0.0;
}

double Material::reflectance(double wavelength_um, double angle) const {
  double sum = 0.0;
  for (const auto& r : reflections) sum += r->hemispherical(wavelength_um, angle);
  return sum;
}

double Material::emissivity(double wavelength_um, double angle) const {
  return given ? given->at(wavelength_um, angle) : 1.0 - reflectance(wavelength_um, angle) - transmittance(wavelength_um, angle);
}

std::vector<double> Material::viewKnots_rad() const {
  std::vector<double> all;
  for (const ViewSpectrum* v : {given ? &*given : nullptr, transmission ? &*transmission : nullptr})
    if (v) {
      const auto knots = v->knots_rad();
      all.insert(all.end(), knots.begin(), knots.end());
    }
  for (const auto& r : reflections)
    for (const AngleAxis& axis : r->axes())
      if (axis.angle == Angle::View)
        for (int j = 0; j < axis.count; ++j) all.push_back(axis.at(j));
  std::erase_if(all, [](double a) { return a >= 0.5 * kPi; });
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

bool Material::hemisphericalVaries() const {
  return (given && given->varies()) || (transmission && transmission->varies()) ||
         std::any_of(reflections.begin(), reflections.end(), [](const auto& r) { return r->hemisphericalVaries(); });
}

bool Material::needsAngles() const {
  return hemisphericalVaries() || std::any_of(reflections.begin(), reflections.end(), [](const auto& r) { return r->axes()[0].angle != Angle::None; });
}

bool Material::hasModifiers() const {
  return states || std::any_of(modifiers.begin(), modifiers.end(), [](int m) { return m >= 0; }) || (given && given->modifier >= 0) ||
         (transmission && transmission->modifier >= 0);
}

double Material::validLow_um() const {
  if (medium) return medium->validLow_um();
  double low = given ? given->validLow_um() : kShortestWavelength_um;
  if (transmission) low = std::max(low, transmission->validLow_um());
  for (const auto& r : reflections) low = std::max(low, r->validLow_um());
  return low;
}
double Material::validHigh_um() const {
  if (medium) return medium->validHigh_um();
  double high = given ? given->validHigh_um() : kLongestWavelength_um;
  if (transmission) high = std::min(high, transmission->validHigh_um());
  for (const auto& r : reflections) high = std::min(high, r->validHigh_um());
  return high;
}

}  // namespace pitviper
