#include "sim/model/view_spectrum.hpp"

#include <algorithm>

namespace pitviper {

double ViewSpectrum::at(double wavelength_um, double angle) const {
  if (model) return model->at(wavelength_um, angle);
  if (tabulated()) {
    const auto& x = table.wavelength_um;
    if (wavelength_um < x.front() || wavelength_um > x.back())
      throw OutsideSpectrum("a table over view angles has no data at " + std::to_string(wavelength_um) + " um");
    const size_t n = x.size();
    const size_t i = n < 2 ? 0 : std::min(static_cast<size_t>(std::upper_bound(x.begin(), x.end(), wavelength_um) - x.begin()) - 1, n - 2);
    const double f = n < 2 ? 0.0 : (wavelength_um - x[i]) / (x[i + 1] - x[i]);
    const double y = std::clamp(angle / table.view.last_rad, 0.0, 1.0) * (table.view.count - 1);
    const size_t j = std::min(static_cast<size_t>(y), static_cast<size_t>(table.view.count - 2));
    const double g = y - static_cast<double>(j);
    auto along = [&](size_t row) { return (1.0 - f) * table.values[row * n + i] + (f > 0.0 ? f * table.values[row * n + i + 1] : 0.0); };
    return (1.0 - g) * along(j) + g * along(j + 1);
  }
  const double normal = spectrum(wavelength_um);
  if (viewAngle_rad.empty()) return normal;
  if (angle <= viewAngle_rad.front()) return normal * factor.front();
  if (angle >= viewAngle_rad.back()) return normal * factor.back();
  const auto above = std::upper_bound(viewAngle_rad.begin(), viewAngle_rad.end(), angle);
  const size_t i = static_cast<size_t>(above - viewAngle_rad.begin()) - 1;
  const double f = (angle - viewAngle_rad[i]) / (viewAngle_rad[i + 1] - viewAngle_rad[i]);
  return normal * (factor[i] + f * (factor[i + 1] - factor[i]));
}

std::vector<double> ViewSpectrum::knots_rad() const {
  if (model) return model->knots_rad();
  if (!tabulated()) return viewAngle_rad;
  std::vector<double> all;
  for (int j = 0; j < table.view.count; ++j) all.push_back(table.view.at(j));
  return all;
}

}  // namespace pitviper
