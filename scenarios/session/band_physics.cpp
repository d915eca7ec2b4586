#include "scenarios/session/band_physics.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/session/array_checks.hpp"
#include "sensors/quantity.hpp"
#include "sim/model/band_temperature.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiance/node_planck.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

/// Both ends of BandTemperature.
constexpr double kColdestBody_K = 20.0, kHottestBody_K = 20000.0;
/// Of colder bodies not even 1000 um sees anything: exp(-719).
constexpr double kDark_K = 0.02;

enum class OfBodies { Value, Slope };

/// [temperature x nodes + node].
std::vector<double> bodiesAt(const std::vector<SpectralNode>& nodes, std::span<const double> temperature_K, OfBodies wanted) {
  const NodePlanck planck(nodes);
  std::vector<double> all(temperature_K.size() * nodes.size(), 0.0), other(nodes.size());
  for (std::size_t t = 0; t < temperature_K.size(); ++t) {
    if (!(temperature_K[t] > kDark_K)) continue;
    const std::span<double> into = std::span(all).subspan(t * nodes.size(), nodes.size());
    if (wanted == OfBodies::Value) planck.at(temperature_K[t], into);
    else planck.at(temperature_K[t], other, into);
  }
  return all;
}

std::vector<double> spectralBodies(const char* function, std::span<const double> wavelength_um, std::span<const double> temperature_K, LightUnit unit,
                                   OfBodies wanted) {
  requireWavelengths({function, "wavelength_um"}, wavelength_um);
  requireNotNegative({function, "temperature_K"}, temperature_K);
  std::vector<SpectralNode> nodes(wavelength_um.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    nodes[i].members = {{wavelength_um[i], unit == LightUnit::Photons ? kPhotonsPerJoulePerUm * wavelength_um[i] : 1.0}};
  return bodiesAt(nodes, temperature_K, wanted);
}

Spectrum responsivityKernel(const Responsivity& band, LightUnit unit) {
  return unit == LightUnit::Photons ? band.spectrum() * photonsPerJoule() : band.spectrum();
}

/// One node that stands for a whole band: the places of the house's integral over it, with their weights times the kernel. An octave at a time: what is
/// longer is divided evenly there, too coarsely at its short end.
std::vector<SpectralNode> bandNode(const Responsivity& band, LightUnit unit) {
  const Spectrum kernel = responsivityKernel(band, unit);
  std::vector<double> edges = kernel.knots();
  for (double um = 2.0 * band.low_um(); um < band.high_um(); um *= 2.0) edges.push_back(um);
  std::sort(edges.begin(), edges.end());
  std::vector<SpectralNode> one(1);
  for (const QuadratureNode& n : fineNodes(band.low_um(), band.high_um(), edges, 16))
    if (const double weight = n.weight * kernel(n.x); weight != 0.0) one.front().members.push_back({n.x, weight});
  return one;
}

Spectrum arrayTable(std::span<const double> wavelength_um, std::span<const double> values, Outside outside) {
  return Spectrum(Spectrum::Table{{wavelength_um.begin(), wavelength_um.end()}, {values.begin(), values.end()}, outside, "an array"});
}

Spectrum requireArrayTable(const char* function, std::span<const double> wavelength_um, std::span<const double> values) {
  requireSameLength({function, "values"}, values, wavelength_um);
  requireSpectralAxis({function, "wavelength_um"}, wavelength_um);
  requireFinite({function, "values"}, values);
  return arrayTable(wavelength_um, values, Outside::Error);
}

double integralOverBand(const char* function, std::span<const double> wavelength_um, std::span<const double> values, const Responsivity& band) {
  const Spectrum table = requireArrayTable(function, wavelength_um, values);
  // Ends of tables made in wavenumbers are rounded.
  constexpr double kRounding = 1e-12;
  if (band.low_um() < table.validLow() * (1.0 - kRounding) || band.high_um() > table.validHigh() * (1.0 + kRounding))
    throw UserError({function, 0, 0, -1},
                    print("the responsivity reaches from %.6g to %.6g um, the values from %.6g to %.6g um", band.low_um(), band.high_um(), table.validLow(),
                          table.validHigh()),
                    "values wherever it responds", "extend the values, or cut the responsivity off where they end");
  return (band.spectrum() * table).integral(std::max(band.low_um(), table.validLow()), std::min(band.high_um(), table.validHigh()));
}

constexpr const char* kResponsivityCall = "responsivity()";

Spectrum responseTable(std::span<const double> wavelength_um, std::span<const double> value) {
  requireSameLength({kResponsivityCall, "value"}, value, wavelength_um);
  requireSpectralAxis({kResponsivityCall, "wavelength_um"}, wavelength_um);
  requireNotNegative({kResponsivityCall, "value"}, value);
  return arrayTable(wavelength_um, value, Outside::Zero);
}

Spectrum responseBand(double low_um, double high_um) {
  const double both[] = {low_um, high_um};
  requireWavelengths({kResponsivityCall, "band_um"}, both);
  requireSpectralAxis({kResponsivityCall, "band_um"}, both);
  return Spectrum::band(low_um, high_um);
}

}  // namespace

std::vector<double> planckRadiance(std::span<const double> wavelength_um, std::span<const double> temperature_K, LightUnit unit) {
  return spectralBodies("planck_radiance()", wavelength_um, temperature_K, unit, OfBodies::Value);
}

std::vector<double> planckSlope(std::span<const double> wavelength_um, std::span<const double> temperature_K, LightUnit unit) {
  return spectralBodies("planck_slope()", wavelength_um, temperature_K, unit, OfBodies::Slope);
}

Responsivity::Responsivity(double low_um, double high_um) : Responsivity(responseBand(low_um, high_um)) {}

Responsivity::Responsivity(std::span<const double> wavelength_um, std::span<const double> value) : Responsivity(responseTable(wavelength_um, value)) {}

Responsivity::Responsivity(Spectrum spectrum) : spectrum_(std::move(spectrum)) {
  const Location where{kResponsivityCall, 0, 0, -1};
  if (spectrum_.validLow() > low_um() || spectrum_.validHigh() < high_um())
    throw UserError(where,
                    print("a responsivity with data from %.6g to %.6g um that reaches from %.6g to %.6g um", spectrum_.validLow(), spectrum_.validHigh(),
                          low_um(), high_um()),
                    "data wherever it responds", "cut it off where they end");
  if (!(low_um() < high_um() && integral_um() > 0.0))
    throw UserError(where, "a responsivity that is 0 throughout", "one that is above 0 somewhere", "check its values");
}

std::vector<double> bandRadiance(std::span<const double> temperature_K, const Responsivity& band, LightUnit unit) {
  requireNotNegative({"band_radiance()", "temperature_K"}, temperature_K);
  return bodiesAt(bandNode(band, unit), temperature_K, OfBodies::Value);
}

std::vector<double> bandRadianceSlope(std::span<const double> temperature_K, const Responsivity& band, LightUnit unit) {
  requireNotNegative({"band_radiance_slope()", "temperature_K"}, temperature_K);
  return bodiesAt(bandNode(band, unit), temperature_K, OfBodies::Slope);
}

std::vector<double> apparentTemperature(std::span<const double> radiance, const Responsivity& band, LightUnit unit) {
  requireNotNegative({"apparent_temperature()", "radiance"}, radiance);
  const BandTemperature table(responsivityKernel(band, unit), band.low_um(), band.high_um());
  const NodePlanck planck(bandNode(band, unit));
  std::vector<double> all;
  all.reserve(radiance.size());
  for (const double wanted : radiance) {
    double kelvin = table(wanted), here = 0.0, slope = 0.0;
    if (kelvin > kColdestBody_K && kelvin < kHottestBody_K) {
      planck.at(kelvin, {&here, 1}, {&slope, 1});
      if (slope > 0.0) kelvin -= (here - wanted) / slope;
    }
    all.push_back(kelvin);
  }
  return all;
}

double bandIntegral(std::span<const double> wavelength_um, std::span<const double> values) {
  const Spectrum table = requireArrayTable("band_integral()", wavelength_um, values);
  return table.integral(table.validLow(), table.validHigh());
}

double bandIntegral(std::span<const double> wavelength_um, std::span<const double> values, const Responsivity& band) {
  return integralOverBand("band_integral()", wavelength_um, values, band);
}

double bandMean(std::span<const double> wavelength_um, std::span<const double> values, const Responsivity& band) {
  return integralOverBand("band_mean()", wavelength_um, values, band) / band.integral_um();
}

}  // namespace pitviper
