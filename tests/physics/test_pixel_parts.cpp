// What a pixel is made of as numbers, and its spectrum: against closed forms, the whole, and the reference's picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scenarios/commands/commands.hpp"
#include "sim/frame/pixel_parts.hpp"
#include "sim/parameters/error.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr int kMiddle = 1;

/// A grey plate of 320 K, 2 km away in even air, lit by a lamp and the sun; the whole film sees it.
Simulation litPlate() {
  return scene(
      "materials: {m: {components: [{reflection: lambertian, reflectance: 0.4}]}}\n"
      "atmosphere: {extinction: 0.3 /km, temperature: 280 K}\n"
      "sun: {azimuth: 90 deg, elevation: 30 deg, irradiance: 20 W/(m2 um)}\n"
      "lights: [{name: lamp, intensity: 5000 W/(sr um), visible: false, position: [20 m, 3 m, 0 m]}]\n"
      "entities: [{name: p, shape: {model: plate, width: 400 m, height: 400 m}, material: m, temperature: 320 K}]\n"
      "cameras: [{name: c, film: {width: 3, height: 3}, field_of_view: 0.02 deg, aperture: 20 mm, position: [2 km, 0 m, 0 m], look_at: [0 m, 0 m, 0 m],\n"
      "           channels: [{name: lw, response: {band: [8 um, 12 um]}}, {name: mw, response: {band: [3 um, 5 um]}, output: [radiance, "
      "apparent_temperature]}]}]\n");
}

PixelPartsMeter meterOf(const Simulation& sim) {
  needContext();
  return {sim, sim.cameras.at(0), shaderLibrary(), std::make_shared<const GpuScene>(sim)};
}

template <class Parts>
const std::vector<double>& named(const Parts& parts, const std::string& name) {
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const auto& p) { return p.name == name; });
  if (found == parts.end()) throw std::runtime_error("no part '" + name + "'");
  return found->values;
}

/// The largest of |all - sum of parts - rest| / all, and of |rest| / all.
template <class Parts>
std::pair<double, double> offWhole(const std::vector<double>& all, const Parts& parts, const std::vector<double>& rest) {
  double off = 0.0, left = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    double sum = rest[k];
    for (const auto& p : parts) sum += p.values[k];
    off = std::max(off, std::abs(sum / all[k] - 1.0));
    left = std::max(left, std::abs(rest[k] / all[k]));
  }
  return {off, left};
}

TEST(PixelParts, OfALitPlateInAir) {
  const Simulation sim = litPlate();
  PixelPartsMeter meter = meterOf(sim);
  const PixelParts p = meter.at(advance(sim, sim.time.at(0)), kMiddle, kMiddle);
  const char* closed = "closed form; middles of bins, pictures in single precision";
  const double passes = std::exp(-0.3 * 2.0);
  ASSERT_EQ(p.columns.front().layer, "lw.radiance");
  EXPECT_EQ(p.columns.front().unit, "W/(m2 sr)");
  figure("pixel's emission through air [W/(m2 sr)]", named(p.rows, "emission of surfaces: p")[0], 0.6 * blackBodyBand(8, 12, 320) * passes, 2e-5, closed);
  figure("pixel's air [W/(m2 sr)]", named(p.rows, "emission of the air")[0], blackBodyBand(8, 12, 280) * (1.0 - passes), 2e-5, closed);
  const double lamp_m = std::hypot(20.0, 3.0);
  figure("pixel's light of a lamp [W/(m2 sr)]", named(p.rows, "reflected light of lamp: p")[0],
         0.4 / kPi * 4.0 * 5000.0 * (20.0 / lamp_m) / (lamp_m * lamp_m) * std::exp(-0.3e-3 * (2000.0 + lamp_m)), 2e-5, closed);
  EXPECT_GT(named(p.rows, "reflected sunlight: p")[0], 0.0);
  EXPECT_EQ(p.rows.size(), 4u);
  const auto [off, left] = offWhole(p.all, p.rows, p.rest);
  bound("rows and rest of a pixel against the whole", off, 1e-9, "the rest is what rows leave, in double precision");
  bound("what rows of a pixel leave", left, 5 * std::ldexp(1.0, -24), "single precision of five pictures, each rounded to 2^-24 of no more than the whole");
}

// The same numbers as a picture that the reference draws whole.
TEST(PixelParts, AreOfTheReferencesPicture) {
  Simulation sim = litPlate();
  PixelPartsMeter meter = meterOf(sim);
  const WorldState state = advance(sim, sim.time.at(0));
  sim.cameras[0].spectral.reference = true;
  const Frame frame = renderFrame(sim);
  for (const auto& [column, row] : {std::pair{0, 2}, {2, 1}}) {
    const PixelParts p = meter.at(state, column, row);
    EXPECT_EQ(static_cast<float>(p.all[0]), static_cast<float>(at(layer(frame, "lw.radiance"), frame, column, row)));
    const auto mw = static_cast<std::size_t>(
        std::find_if(p.columns.begin(), p.columns.end(), [](const auto& c) { return c.layer == "mw.apparent_temperature"; }) - p.columns.begin());
    ASSERT_LT(mw, p.columns.size());
    EXPECT_EQ(p.columns[mw].unit, "W/(m2 sr)");
    const double seen_K = at(layer(frame, "mw.apparent_temperature"), frame, column, row);
    // A picture keeps 24 bits of radiance and of temperature.
    EXPECT_NEAR(apparentTemperature_K(p.columns[mw], p.all[mw]).value(), seen_K, 2e-7 * seen_K);
  }
}

// Of a black body alone its own temperature, and of nothing none.
TEST(PixelParts, ApparentTemperature) {
  const Simulation sim = litPlate();
  PixelPartsMeter meter = meterOf(sim);
  const PixelParts p = meter.at(advance(sim, sim.time.at(0)), kMiddle, kMiddle);
  // Within 1e-5 K per kelvin (BandTemperature).
  EXPECT_NEAR(apparentTemperature_K(p.columns[0], blackBodyBand(8, 12, 320)).value(), 320.0, 3e-3);
  EXPECT_FALSE(apparentTemperature_K(p.columns[0], 0.0));
  EXPECT_FALSE(apparentTemperature_K(p.columns[0], -1.0));
  EXPECT_FALSE(apparentTemperature_K(p.columns[0], 1e-300));
  EXPECT_FALSE(apparentTemperature_K(p.columns[0], 1e30));
}

TEST(PixelParts, SpectrumOfALitPlateInAir) {
  const Simulation sim = litPlate();
  PixelPartsMeter meter = meterOf(sim);
  const WorldState state = advance(sim, sim.time.at(0));
  const PixelParts p = meter.at(state, kMiddle, kMiddle);
  const PixelSpectrum s = meter.spectrum(state, kMiddle, kMiddle, 8.0, 12.0, 40);
  ASSERT_EQ(s.edge_um.size(), 41u);
  ASSERT_EQ(s.wavelength_um.size(), 40u);
  EXPECT_DOUBLE_EQ(s.wavelength_um[0], 8.05);
  const auto [off, left] = offWhole(s.all, s.parts, s.rest);
  bound("curves and rest of a spectrum against the whole", off, 1e-9, "the rest is what curves leave, in double precision");
  bound("what curves of a spectrum leave", left, 5 * std::ldexp(1.0, -24), "single precision of five pictures");
  // The spectrum's bins end where the channel's band does: its integral is the same but for where bins of the reference lie.
  const Spectrum& kernel = sim.cameras[0].outputs[0].kernel;
  const auto integral = [&](const std::vector<double>& values) {
    double sum = 0.0;
    for (std::size_t b = 0; b < values.size(); ++b) sum += kernel.integral(s.edge_um[b], s.edge_um[b + 1]) * values[b];
    return sum * p.columns[0].perIntegral;
  };
  const char* middles = "two grids of middles; pictures in single precision";
  figure("integral of a pixel's spectrum [W/(m2 sr)]", integral(s.all), p.all[0], 1e-5, middles);
  figure("integral of the spectrum of its emission", integral(named(s.parts, "emission of surfaces")), named(p.rows, "emission of surfaces: p")[0], 1e-5,
         middles);
  figure("integral of the spectrum of a lamp's light", integral(named(s.parts, "reflected light of lamp")), named(p.rows, "reflected light of lamp: p")[0],
         1e-5, middles);
  // One bin alone: its mean.
  figure("a bin of a pixel's emission [W/(m2 sr um)]", named(s.parts, "emission of surfaces")[7],
         0.6 * std::exp(-0.6) * blackBodyBand(s.edge_um[7], s.edge_um[8], 320) / 0.1, 2e-5, "closed form; middles of bins, pictures in single precision");
}

// A response that bends between the edges of bins, in the bands of real air: bins average what it and the air have in common.
TEST(PixelParts, SpectrumThroughARealAirAndASlopingResponse) {
  const Simulation sim = scene(
      "atmosphere: {library: hazy_mls}\n"
      "sun: {azimuth: 180 deg, elevation: 40 deg, temperature: 5772 K}\n"
      "ambient: {temperature: 280 K}\n"
      "entities:\n"
      "  - {name: ground, shape: {model: plate, width: 20 km, height: 20 km}, pitch: 90 deg, material: sand, temperature: 290 K, position: [0 m, 0 m, 0 m]}\n"
      "  - {name: gas, shape: {model: ellipsoid, length: 30 m, width: 30 m, height: 20 m}, material: jet_exhaust, temperature: 600 K, position: [0 m, 700 m, "
      "461 m]}\n"
      "cameras: [{name: c, film: {width: 5, height: 5}, field_of_view: 3 deg, aperture: 20 mm, position: [0 m, 0 m, 500 m], look_at: [0 m, 900 m, 450 m],\n"
      "           channels: [{name: mw, response: {wavelength: um, unit: 1, values: [[3.5, 0], [3.9, 1], [4.4, 0]]}}]}]\n");
  PixelPartsMeter meter = meterOf(sim);
  const WorldState state = advance(sim, sim.time.at(0));
  const auto offIntegral = [&](const PixelSpectrum& s, int column, int row) {
    const PixelParts p = meter.at(state, column, row);
    double sum = 0.0;
    for (std::size_t b = 0; b < s.all.size(); ++b) sum += sim.cameras[0].outputs[0].kernel.integral(s.edge_um[b], s.edge_um[b + 1]) * s.all[b];
    return std::abs(sum * p.columns[0].perIntegral / p.all[0] - 1.0);
  };
  bound("integral of a spectrum through real air, off", offIntegral(meter.spectrum(state, 2, 4, 3.5, 4.4, 180), 2, 4), 1e-3,
        "bins of 5 nm: what response and radiance have in common over one is h2/12 of the product of their slopes");
  const PixelSpectrum s = meter.spectrum(state, 2, 2, 3.5, 4.4, 180);
  bound("integral of a spectrum of hot gas through real air, off", offIntegral(s, 2, 2), 1e-2,
        "two sets of wavelengths in the steep edge of hot CO2 behind cold: finer bins don't bring them together, 0.08 to 0.7 % were seen");
  std::set<TermKind> kinds;
  for (const auto& c : s.parts) kinds.insert(c.part.kind);
  for (TermKind kind : {TermKind::Emission, TermKind::Ambient, TermKind::Sun, TermKind::AirEmission, TermKind::ScatteredSun, TermKind::Media})
    EXPECT_TRUE(kinds.count(kind)) << nameOf(kind);
  for (const auto& c : s.parts) EXPECT_EQ(c.part.entity, -1) << c.name;
  const auto [off, left] = offWhole(s.all, s.parts, s.rest);
  bound("curves and rest of a spectrum in real air against the whole", off, 1e-9, "the rest is what curves leave, in double precision");
  bound("what curves of a spectrum in real air leave", left, 1e-6, "single precision of a picture for each part");
}

// The sun's disc is no part of its own: it is what the rows leave.
TEST(PixelParts, RestIsTheSunsDisc) {
  const Simulation sim = scene(
      "sun: {azimuth: 90 deg, elevation: 0 deg, irradiance: 20 W/(m2 um)}\n"
      "background: {temperature: 250 K}\n"
      "cameras: [{name: c, film: {width: 20, height: 20}, field_of_view: 0.1 deg, aperture: 20 mm, position: [0 m, 0 m, 0 m], look_at: [1 km, 0 m, 0 m],\n"
      "           channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n");
  PixelPartsMeter meter = meterOf(sim);
  const PixelParts p = meter.at(advance(sim, sim.time.at(0)), kMiddle, kMiddle);
  figure("the sun's disc as the rest [W/(m2 sr)]", p.rest[0], 4.0 * 20.0 / (kPi * std::pow(physics::sunRadius(), 2)), 2e-7, "E / (pi r^2); single precision");
  EXPECT_NEAR(named(p.rows, "background")[0] + p.rest[0], p.all[0], 1e-9 * p.all[0]);
}

TEST(PixelParts, RefusesWhatIsNotThere) {
  const Simulation sim = litPlate();
  PixelPartsMeter meter = meterOf(sim);
  const WorldState state = advance(sim, sim.time.at(0));
  EXPECT_THROW(meter.at(state, 3, 0), UserError);
  EXPECT_THROW(meter.at(state, 0, -1), UserError);
  EXPECT_THROW(meter.spectrum(state, 0, 0, 5.0, 4.0, 10), UserError);
  EXPECT_THROW(meter.spectrum(state, 0, 0, 4.0, 5.0, 0), UserError);
  EXPECT_THROW(meter.spectrum(state, 0, 3, 4.0, 5.0, 1), UserError);
}

}  // namespace
}  // namespace pitviper::test
