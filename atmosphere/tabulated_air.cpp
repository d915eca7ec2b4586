#include "atmosphere/tabulated_air.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {
namespace {

// Between which two entries, and how far from the first.
struct Place {
  size_t i;
  double f;
};

Place placeOf(std::span<const double> rising, double wavelength_um) {
  constexpr double kRounding = 1e-12;  // ends that went through 1e4 / nu
  if (!(wavelength_um >= rising.front() * (1.0 - kRounding) && wavelength_um <= rising.back() * (1.0 + kRounding)))
    throw OutsideSpectrum("the table of the air has no data at " + std::to_string(wavelength_um) + " um");
  const auto above = std::upper_bound(rising.begin() + 1, rising.end() - 1, wavelength_um);
  const auto i = static_cast<size_t>(above - rising.begin()) - 1;
  return {i, std::clamp((wavelength_um - rising[i]) / (rising[i + 1] - rising[i]), 0.0, 1.0)};
}

bool rises(std::span<const double> x) {
  for (size_t i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i]) || (i > 0 && x[i] <= x[i - 1])) return false;
  return x.size() >= 2;
}

bool allAtLeastZero(std::span<const double> x) {
  return std::all_of(x.begin(), x.end(), [](double v) { return std::isfinite(v) && v >= 0.0; });
}

void require(bool condition, const char* what) {
  if (!condition) throw std::invalid_argument(std::string("table of air: ") + what);
}

// Kasten and Young 1989, Applied Optics 28, 4735: air mass relative to the zenith's, elevation 0 to 90 degrees.
double airMass(double elevation_rad) {
  const double degrees = std::max(elevation_rad, 0.0) * 180.0 / kPi;
  return 1.0 / (std::sin(std::max(elevation_rad, 0.0)) + 0.50572 * std::pow(degrees + 6.07995, -1.6364));
}

}  // namespace

TabulatedSky::TabulatedSky(std::vector<double> wavelength_um, std::vector<View> views) : wavelength_um_(std::move(wavelength_um)), views_(std::move(views)) {
  require(rises(wavelength_um_), "wavelengths of the sky do not rise");
  require(!views_.empty(), "a sky without views");
  for (const View& v : views_) require(v.radiance.size() == wavelength_um_.size() && allAtLeastZero(v.radiance), "radiances of the sky");
  std::sort(views_.begin(), views_.end(), [](const View& a, const View& b) { return a.elevation_rad < b.elevation_rad; });
}

double TabulatedSky::radiance(double wavelength_um, double elevation_rad) const {
  const auto [i, f] = placeOf(wavelength_um_, wavelength_um);
  const auto of = [&](const View& v) { return v.radiance[i] + f * (v.radiance[i + 1] - v.radiance[i]); };
  if (elevation_rad <= views_.front().elevation_rad) return of(views_.front());
  for (size_t k = 1; k < views_.size(); ++k) {
    if (elevation_rad > views_[k].elevation_rad) continue;
    const double low = airMass(views_[k - 1].elevation_rad), high = airMass(views_[k].elevation_rad), here = airMass(elevation_rad);
    const double g = low == high ? 1.0 : (here - low) / (high - low);
    return of(views_[k - 1]) + g * (of(views_[k]) - of(views_[k - 1]));
  }
  return of(views_.back());
}

TabulatedAir::TabulatedAir(Data data) : data_(std::move(data)) {
  require(rises(data_.wavelength_um), "wavelengths do not rise");
  require(!data_.exponents.empty(), "no exponents");
  for (double a : data_.exponents) require(a > 0.0 && a <= 1.0, "an exponent outside 0 to 1");
  require(data_.depth.size() == data_.wavelength_um.size(), "as many depths as wavelengths");
  for (const auto& c : data_.depth) require(c.size() == data_.exponents.size() && allAtLeastZero(c), "depths");
  require(!emits() || (data_.sourceRadiance.size() == data_.wavelength_um.size() && allAtLeastZero(data_.sourceRadiance)), "source radiances");
}

void TabulatedAir::addTo(Fingerprint& f) const {
  f.all(data_.wavelength_um).all(data_.exponents).all(data_.sourceRadiance);
  for (const auto& row : data_.depth) f.all(row);
}

std::vector<double> TabulatedAir::coefficients(double wavelength_um) const {
  const auto [i, f] = placeOf(data_.wavelength_um, wavelength_um);
  std::vector<double> c(data_.exponents.size());
  for (size_t k = 0; k < c.size(); ++k) c[k] = data_.depth[i][k] + f * (data_.depth[i + 1][k] - data_.depth[i][k]);
  return c;
}

double TabulatedAir::sourceRadiance(double wavelength_um) const {
  const auto [i, f] = placeOf(data_.wavelength_um, wavelength_um);
  return emits() ? data_.sourceRadiance[i] + f * (data_.sourceRadiance[i + 1] - data_.sourceRadiance[i]) : 0.0;
}

double TabulatedAir::opticalDepth(double wavelength_um, double range_m) const {
  const auto c = coefficients(wavelength_um);
  double depth = 0.0;
  for (size_t k = 0; k < c.size(); ++k) depth += c[k] * std::pow(1e-3 * range_m, data_.exponents[k]);
  return depth;
}

double TabulatedAir::transmittance(double wavelength_um, double range_m) const { return std::exp(-opticalDepth(wavelength_um, range_m)); }

double TabulatedAir::pathRadiance(double wavelength_um, double range_m) const {
  return sourceRadiance(wavelength_um) * physics::oneMinusExp(opticalDepth(wavelength_um, range_m));
}

void TabulatedAir::requireBand(double low_um, double high_um, const std::string& sensor) const {
  constexpr double kRounding = 1e-9;
  if (low_um >= validLow_um() * (1.0 - kRounding) && high_um <= validHigh_um() * (1.0 + kRounding)) return;
  throw UserError({data_.file, data_.line, 1, -1},
                  "the air covers " + briefNumber(validLow_um()) + " to " + briefNumber(validHigh_um()) + " um, not the " + briefNumber(low_um) + " to " +
                      briefNumber(high_um) + " um of " + sensor,
                  "a table over all of it",
                  "add rows from " + briefNumber(low_um) + " to " + briefNumber(high_um) + " um (" + briefNumber(std::floor(1e4 / high_um)) + " to " +
                      briefNumber(std::ceil(1e4 / low_um)) + " 1/cm)");
}

}  // namespace pitviper
