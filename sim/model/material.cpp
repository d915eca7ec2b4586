#include "sim/model/material.hpp"

#include <algorithm>

#include "sim/radiometry/constants.hpp"

namespace pitviper {

double GivenEmissivity::at(double wavelength_um, double angle) const {
  if (tabulated()) {
    const auto& x = table.wavelength_um;
    if (wavelength_um < x.front() || wavelength_um > x.back())
      throw OutsideSpectrum("an emissivity table has no data at " + std::to_string(wavelength_um) + " um");
    const size_t n = x.size();
    const size_t i = n < 2 ? 0 : std::min(static_cast<size_t>(std::upper_bound(x.begin(), x.end(), wavelength_um) - x.begin()) - 1, n - 2);
    const double f = n < 2 ? 0.0 : (wavelength_um - x[i]) / (x[i + 1] - x[i]);
    const double y = std::clamp(angle / table.view.last_rad, 0.0, 1.0) * (table.view.count - 1);
    const size_t j = std::min(static_cast<size_t>(y), static_cast<size_t>(table.view.count - 2));
    const double g = y - static_cast<double>(j);
    auto along = [&](size_t row) { return (1.0 - f) * table.values[row * n + i] + (f > 0.0 ? f * table.values[row * n + i + 1] : 0.0); };
    return (1.0 - g) * along(j) + g * along(j + 1);
  }
  const double eps = emissivity(wavelength_um);
  if (viewAngle_rad.empty()) return eps;
  if (angle <= viewAngle_rad.front()) return eps * factor.front();
  if (angle >= viewAngle_rad.back()) return eps * factor.back();
  const auto above = std::upper_bound(viewAngle_rad.begin(), viewAngle_rad.end(), angle);
  const size_t i = static_cast<size_t>(above - viewAngle_rad.begin()) - 1;
  const double f = (angle - viewAngle_rad[i]) / (viewAngle_rad[i + 1] - viewAngle_rad[i]);
  return eps * (factor[i] + f * (factor[i + 1] - factor[i]));
}

std::vector<double> GivenEmissivity::knots_rad() const {
  if (!tabulated()) return viewAngle_rad;
  std::vector<double> all;
  for (int j = 0; j < table.view.count; ++j) all.push_back(table.view.at(j));
  return all;
}

double Material::reflectance(double wavelength_um, double angle) const {
  double sum = 0.0;
  for (const auto& r : reflections) sum += r->hemispherical(wavelength_um, angle);
  return sum;
}

double Material::emissivity(double wavelength_um, double angle) const {
  return given ? given->at(wavelength_um, angle) : 1.0 - reflectance(wavelength_um, angle);
}

std::vector<double> Material::viewKnots_rad() const {
  std::vector<double> all;
  if (given) all = given->knots_rad();
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
  return (given && given->varies()) || std::any_of(reflections.begin(), reflections.end(), [](const auto& r) { return r->hemisphericalVaries(); });
}

bool Material::needsAngles() const {
  return hemisphericalVaries() || std::any_of(reflections.begin(), reflections.end(), [](const auto& r) { return r->axes()[0].angle != Angle::None; });
}

bool Material::hasModifiers() const {
  return std::any_of(modifiers.begin(), modifiers.end(), [](int m) { return m >= 0; }) || (given && given->modifier >= 0);
}

double Material::validLow_um() const {
  double low = given ? given->validLow_um() : kShortestWavelength_um;
  for (const auto& r : reflections) low = std::max(low, r->validLow_um());
  return low;
}
double Material::validHigh_um() const {
  double high = given ? given->validHigh_um() : kLongestWavelength_um;
  for (const auto& r : reflections) high = std::min(high, r->validHigh_um());
  return high;
}

}  // namespace pitviper
