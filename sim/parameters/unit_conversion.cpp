#include "sim/parameters/unit_conversion.hpp"

#include "sim/parameters/print.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

/// Planck's constant times the speed of light [J m]. Source: CODATA 2018, exact.
constexpr double kPlanckLight_J_m = 6.62607015e-34 * 299792458.0;

enum Dimension : std::size_t { kWatt, kMetre, kSecond, kKelvin, kRadian, kSteradian, kVolt, kCount };

std::string number(double v) { return print("%.7g", v); }

}  // namespace

std::string conversionOf(std::string_view unit, std::string_view canonical) {
  const std::string in = canonical.empty() ? "plain numbers" : std::string(canonical);
  const auto from = parseUnit(unit), to = parseUnit(canonical);
  if (!from || !to) return "convert the values to " + in + "; if they are in it already, write " + (canonical.empty() ? "1" : std::string(canonical));
  const auto with = [&](std::size_t dimension, int by) {
    auto dims = to->dims;
    dims[dimension] += by;
    return dims;
  };
  const double scale = from->factor / to->factor;
  // Per 1/m in place of per m: |d nu / d lambda| = nu^2.
  if (from->dims == with(kMetre, 2)) return "convert the values to " + in + ": times " + number(scale * 1e4) + " nu^2, nu the wavenumber in 1/cm";
  auto photons = to->dims;
  photons[kWatt] -= 1, photons[kCount] += 1, photons[kSecond] -= 1;
  if (from->dims == photons)
    return "convert the values to " + in + ": times " + number(scale * kPlanckLight_J_m * 1e6) + " / lambda, lambda the wavelength in um";
  if (from->dims == with(kSteradian, 1))
    return "convert the values to " + in + ": divided by the solid angle that they come from, pi sr of a surface that is alike from all sides";
  return "convert the values to " + in + "; another name for their unit would not change them";
}

}  // namespace pitviper
