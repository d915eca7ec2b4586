// What a pixel is made of, part by part, against closed forms and against the whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scenarios/commands/commands.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// A camera's wanted pixel by the reference, as a whole and by parts.
struct Parts {
  std::vector<double> whole;  ///< per slot
  std::map<Part, std::vector<double>> of;
};

Parts partsOf(const std::string& yaml, int pixel) {
  needContext();
  Simulation sim = scene(yaml);
  Camera& camera = sim.cameras[0];
  camera.spectral.reference = true;
  camera.zoomedSamples = 32;
  CameraRenderer renderer(sim, camera, cameraPlan(sim, camera), shaderLibrary(), std::make_shared<const GpuScene>(sim));
  renderer.setWanted({pixel});
  renderer.watchParts();
  const WorldState state = advance(sim, sim.time.at(0));
  const auto draw = [&] {
    std::vector<double> values;
    for (const auto& slot : renderer.render(state).slots) values.push_back(slot[static_cast<size_t>(pixel)]);
    return values;
  };
  Parts all;
  all.whole = draw();
  for (const Part& part : renderer.parts()) {
    renderer.setOnly(part);
    all.of[part] = draw();
  }
  return all;
}

// A grey plate that faces two lamps and the sun, 300 K: emission (1 - rho) B, of each light rho/pi I cos/d2, and nothing else.
TEST(Parts, OfALitWarmPlate) {
  const Parts p = partsOf(
      "materials: {m: {components: [{reflection: lambertian, reflectance: 0.4}]}}\n"
      "sun: {azimuth: 90 deg, elevation: 30 deg, irradiance: 20 W/(m2 um)}\n"
      "lights: [{name: one, intensity: 50 W/(sr um), visible: false, position: [4 m, 3 m, 0 m]},\n"
      "         {name: two, intensity: 80 W/(sr um), visible: false, position: [6 m, 0 m, 8 m]}]\n"
      "entities: [{name: p, shape: {model: plate, width: 40 m, height: 40 m}, material: m, temperature: 300 K}]\n"
      "cameras: [{name: c, film: {width: 3, height: 3}, field_of_view: 0.02 deg, aperture: 20 mm, position: [10 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m],\n"
      "           channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n",
      4);
  const double shine = 0.4 / kPi * 4.0;
  const char* rounding = "closed form; middles of bins: h2/24 B''/B, pictures in single precision";
  figure("part of a plate: emission [W/(m2 sr)]", p.of.at({TermKind::Emission, 0, -1})[0], 0.6 * blackBodyBand(8, 12, 300), 2e-5, rounding);
  figure("part of a plate: sunlight [W/(m2 sr)]", p.of.at({TermKind::Sun, 0, -1})[0], shine * 20.0 * std::cos(kPi / 6.0), 2e-5, rounding);
  figure("part of a plate: first lamp [W/(m2 sr)]", p.of.at({TermKind::Lights, 0, 0})[0], shine * 50.0 * 0.8 / 25.0, 2e-5, rounding);
  figure("part of a plate: second lamp [W/(m2 sr)]", p.of.at({TermKind::Lights, 0, 1})[0], shine * 80.0 * 0.6 / 100.0, 2e-5, rounding);
  EXPECT_EQ(p.of.size(), 4u);
}

// A lamp and a body below a pixel through a pane and gas in hazy air in the sun: every kind of part, and their sum.
TEST(Parts, AddUpToTheWhole) {
  const Parts p = partsOf(
      "atmosphere: {library: hazy_mls}\n"
      "sun: {azimuth: 180 deg, elevation: 40 deg, temperature: 5772 K}\n"
      "ambient: {temperature: 280 K}\n"
      "lights: [{name: flare, intensity: {blackbody: 2000 K, area: 0.01 m2}, position: [0.3 m, 900 m, 500.4 m]}]\n"
      "entities:\n"
      "  - {name: ground, shape: {model: plate, width: 20 km, height: 20 km}, pitch: 90 deg, material: sand, temperature: 290 K, position: [0 m, 0 m, 0 m]}\n"
      "  - {name: small, shape: {model: sphere, radius: 0.4 m}, material: grey_aircraft_paint, temperature: 400 K, position: [0 m, 905 m, 500 m]}\n"
      "  - {name: window, shape: {model: plate, width: 3 m, height: 3 m}, material: window_glass, temperature: 310 K, position: [0.2 m, 10 m, 500.3 m], "
      "heading: "
      "180 deg}\n"
      "  - {name: gas, shape: {model: ellipsoid, length: 30 m, width: 30 m, height: 20 m}, material: jet_exhaust, temperature: 600 K, position: [0 m, 700 m, "
      "497 m]}\n"
      "cameras: [{name: c, film: {width: 5, height: 5}, field_of_view: 3 deg, aperture: 20 mm, position: [0 m, 0 m, 500 m], look_at: [0 m, 900 m, 500 m],\n"
      "           channels: [{name: mw, response: {band: [3.8 um, 4.2 um]}}, {name: vis, response: {band: [0.6 um, 0.7 um]}}]}]\n",
      12);
  for (TermKind kind : {TermKind::Emission, TermKind::Ambient, TermKind::Sun, TermKind::Lights, TermKind::AirEmission, TermKind::ScatteredSun, TermKind::Media,
                        TermKind::LampsInView})
    EXPECT_TRUE(std::any_of(p.of.begin(), p.of.end(), [kind](const auto& part) { return part.first.kind == kind; })) << nameOf(kind);
  for (int entity : {1, 2}) EXPECT_TRUE(p.of.count({TermKind::Emission, entity, -1})) << entity;
  for (size_t s = 0; s < p.whole.size(); ++s) {
    double sum = 0.0;
    for (const auto& [part, values] : p.of) {
      // Light scattered again may be less than what air of one temperature would send.
      EXPECT_TRUE(values[s] >= 0.0 || part.kind == TermKind::ScatteredAgain) << nameOf(part.kind);
      sum += values[s];
    }
    bound("parts of a pixel against the whole, channel " + std::to_string(s), std::abs(sum / p.whole[s] - 1.0), 3e-5,
          "a zoomed body is linear between within 2e-5, part by part; pictures in single precision");
  }
}

}  // namespace
}  // namespace pitviper::test
