#include "atmosphere/tape7_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sim/radiometry/spectrum.hpp"

namespace pitviper::tape7 {
namespace {

// Four decimals round to within 0.00005; what is filtered over wavenumber may add a little. A per cent or a shifted column is far beyond.
constexpr double kMostTransmittance = 1.001;

/// W/(cm2 cm-1) to W/(m2 um), both also per sr: with nu = 1e4/lambda, 1e4 cm2/m2 times |dnu/dlambda| = nu^2/1e4 cm-1/um.
bool isPerWavenumber(Tape7Quantity q) { return q == Tape7Quantity::Radiance || q == Tape7Quantity::Irradiance; }

}  // namespace

Tape7Quantity radianceQuantity(const std::string& name) {
  using Q = Tape7Quantity;
  static const std::map<std::string, Q> all = {
      {"TOT_TRANS", Q::Transmittance}, {"PTH_THRML", Q::Radiance},     {"THRML_EM", Q::Radiance},  {"THRML_SCT", Q::Radiance}, {"SURF_EMIS", Q::Radiance},
      {"SOL_SCAT", Q::Radiance},       {"MULT_SCAT", Q::Radiance},     {"SING_SCAT", Q::Radiance}, {"GRND_RFLT", Q::Radiance}, {"DRCT_RFLT", Q::Radiance},
      {"TOTAL_RAD", Q::Radiance},      {"REF_SOL", Q::Irradiance},     {"SOL@OBS", Q::Irradiance}, {"DEPTH", Q::OpticalDepth}, {"DIR_EM", Q::Emissivity},
      {"TOA_SUN", Q::Irradiance},      {"BBODY_T[K]", Q::Temperature},
  };
  const auto found = all.find(name);
  return found == all.end() ? Q::Unknown : found->second;
}

void Rows::begin(double v, const Location& at, const std::string& found) {
  if (!wavenumber_.empty() && !(v > wavenumber_.back())) throw UserError(at, "the wavenumber " + found + " does not rise", "rising wavenumbers in cm-1", fix_);
  if (!(v >= 1e4 / kLongestWavelength_um && v <= 1e4 / kShortestWavelength_um))
    throw UserError(at, "the wavenumber " + found + " lies beyond the spectral axis", "10 to 100000 cm-1 (1000 to 0.1 um)",
                    "run MODTRAN with V1 and V2 within it");
  wavenumber_.push_back(v);
}

void Rows::add(Tape7Column& column, double written, const Location& at, const std::string& found) const {
  if (column.quantity == Tape7Quantity::Transmittance && !(written >= 0.0 && written <= kMostTransmittance))
    throw UserError(at, "the transmittance " + column.name + " is " + found, "0 to 1",
                    "give the file as MODTRAN wrote it: per cent, or columns shifted, are not read");
  const double v = wavenumber_.back(), value = isPerWavenumber(column.quantity) ? written * v * v : written;
  if (!std::isfinite(value)) throw UserError(at, found + " for " + column.name + " is too large", "a radiance or irradiance", again_);
  column.value.push_back(value);
}

void Rows::addGap(Tape7Column& column, int line) const {
  if (column.gapLine == 0) column.gapLine = line;
  column.value.push_back(std::numeric_limits<double>::quiet_NaN());
}

void Rows::finish() {
  std::erase_if(run_.columns, [](const Tape7Column& c) { return std::all_of(c.value.begin(), c.value.end(), [](double x) { return std::isnan(x); }); });
  for (Tape7Column& c : run_.columns) std::reverse(c.value.begin(), c.value.end());
  run_.wavelength_um.reserve(wavenumber_.size());
  for (auto v = wavenumber_.rbegin(); v != wavenumber_.rend(); ++v) run_.wavelength_um.push_back(1e4 / *v);
}

}  // namespace pitviper::tape7
