// Rows of targets and terms of light against closed forms and against the reference.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/frame/truth_table.hpp"
#include "sim/model/stage.hpp"
#include "sim/model/world.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

const TargetRow& row(const Frame& f, const std::string& name) {
  for (const TargetRow& t : f.targets)
    if (t.name == name) return t;
  throw std::runtime_error("no target " + name);
}

std::string camera(const std::string& more, const std::string& place = "position: [0 m, 0 m, 0 m], heading: 90 deg") {
  return "cameras: [{name: c, film: {width: 128, height: 96, pitch: 15 um}, focal_length: 100 mm, aperture: 25 mm, exposure: 4 ms, truth: [targets, terms], " + place + ", " + more +
         "channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}}]}]\n";
}

// A ball far away: epsilon B pi r^2, less what it hides for the contrast; at any range.
TEST(TruthTable, ABallsIntensityAtAnyRange) {
  const double own = 0.7 * blackBodyBand(3.6, 4.9, 400.0), behind = blackBodyBand(3.6, 4.9, 290.0), area = kPi * 4.0;
  for (double range : {300.0, 2000.0, 20000.0, 2e5}) {  // 90 pixels across to a tenth
    const Frame f = renderFrame(scene(
        "background: {temperature: 290 K}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.3}]}}\nentities: [{name: ball, shape: {model: sphere, radius: 2 m, segments: "
        "256}, material: m, temperature: 400 K, position: [" + std::to_string(range) + " m, 0 m, 0 m]}]\n" + camera("")));
    const TargetRow& t = row(f, "ball");
    // Seen from a range R a ball shows the cap up to its horizon: pi r^2 / (1 - (r / R)^2) of solid angle times R^2, nearly.
    const double seen = 2.0 * kPi * (1.0 - std::sqrt(1.0 - std::pow(2.0 / range, 2.0))) * range * range;
    figure(print("own intensity of a ball at %g m [W/sr]", range), t.channels[0].own, own * seen, 3e-3, "256 segments are 1e-4 short; outline on its lines");
    figure(print("its contrast at %g m [W/sr]", range), t.channels[0].contrast, (own - behind) * seen, 3e-3, "the same");
    EXPECT_NEAR(t.channels[0].total, t.channels[0].own, 1e-9 * t.channels[0].own) << "no air, nothing reflected";
    EXPECT_NEAR(seen, area, 0.01 * area);
    EXPECT_NEAR(t.visible, 1.0, 1e-12);
    EXPECT_NEAR(t.column, 64.0, 1e-6);
    EXPECT_NEAR(t.range_m, range, 1e-6 * range);
    EXPECT_NEAR(t.right - t.left, 4.0 / range * 100e-3 / 15e-6, 0.02 * 4.0 / range * 100e-3 / 15e-6);
  }
}

// Against the reference: what its pixels add up to within the accuracy asked, in air, with a lamp, a plume before it and a hot part.
TEST(TruthTable, AgreesWithTheReference) {
  const std::string world =
      "atmosphere: {model: homogeneous, extinction: 0.05 /km, temperature: 288 K}\nbackground: {temperature: 200 K}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.4}]}, g: "
      "{medium: gas, absorption: 0.05 /m}}\nlights: [{name: lamp, visible: false, intensity: {wavelength: um, unit: W/(sr um), values: [[3, 3e5], [6, 3e5]]}, position: [-100 m, 300 m, 100 m]}]\n"
      "entities:\n- {name: jet, shape: {model: jet}, material: m, temperature: 330 K, position: [RANGE m, 0 m, 0 m], heading: 30 deg}\n- {name: plume, shape: {model: ellipsoid, length: 12 m, "
      "width: 2 m, height: 2 m}, material: g, temperature: 700 K, position: [RANGE m, -12 m, 0 m]}\n";
  for (double range : {300.0, 3000.0, 60000.0}) {
    std::string here = world;
    for (size_t k = here.find("RANGE"); k != std::string::npos; k = here.find("RANGE")) here.replace(k, 5, std::to_string(range));
    const Frame f = renderFrame(scene("accuracy: 1 %\n" + here + camera("")));
    const auto sumOf = [&](const std::string& bodies) {  // of the reference, L w_pix R^2
      std::string text = here;
      if (bodies == "none") text = text.substr(0, text.find("entities:"));
      Simulation sim = scene("accuracy: reference\n" + text + camera("samples: 4, ") );
      sim.cameras[0].truth = {};
      const Frame g = renderFrame(sim);
      const auto sr = sim.cameras[0].pinhole.solidAngles().plain_sr;
      double all = 0.0;
      for (size_t p = 0; p < sr.size(); ++p) all += sr[p] * static_cast<double>(layer(g, "mw.radiance").pixels[p]);
      return all * range * range;
    };
    // Both together: contrasts of things that hide each other do not add up, but the plume's beside the jet do.
    const double both = sumOf("all") - sumOf("none");
    const double told = row(f, "jet").channels[0].contrast + row(f, "plume").channels[0].contrast;
    figure(print("contrast of a jet and its plume at %g m [W/sr]", range), told, both, 0.02, "1 % of each asked for; where one is before the other both count it");
  }
}

// What hides a body, the film's edge, the turning of the line of sight.
TEST(TruthTable, SharesAndRates) {
  const Frame f = renderFrame(scene(
      "time: {rate: 50 Hz, frames: 2}\nbackground: {temperature: 290 K}\nmaterials: {m: {components: []}}\nentities:\n- {name: ball, shape: {model: sphere, radius: 2 m}, material: m, temperature: 400 "
      "K, motion: [{time: -1 s, position: [1000 m, 100 m, -50 m]}, {time: 1 s, position: [1000 m, -100 m, 50 m]}]}\n- {name: wall, shape: {model: plate, width: 10 m, height: 10 m}, material: m, "
      "temperature: 290 K, position: [900 m, 5 m, 0 m], heading: 270 deg}\n- {name: edge, shape: {model: sphere, radius: 2 m}, material: m, temperature: 400 K, position: [1000 m, -9.6 m, 0 m]}\n" +
      camera("")));
  const TargetRow& ball = row(f, "ball");
  figure("turning of the line of sight to the right [rad/s]", ball.sightRight_rad_s, 0.1, 1e-4, "100 m/s at 1 km");
  figure("turning upwards [rad/s]", ball.sightUp_rad_s, 0.05, 1e-4, "50 m/s at 1 km");
  EXPECT_NEAR(ball.rangeRate_m_s, 0.0, 1e-3);
  figure("share of a ball that a wall's edge leaves", ball.visible, 0.5, 0.03, "half");
  figure("share of a ball that the film's edge leaves", row(f, "edge").visible, 0.5, 0.03, "half");
  EXPECT_GT(row(f, "wall").channels[0].total, 0.0);
  const double hidden = 0.5 * kPi * 4.0 * 0.81 * (blackBodyBand(3.6, 4.9, 400.0) - blackBodyBand(3.6, 4.9, 290.0));
  figure("contrast of a wall as warm as what is behind it, but for half a ball [W/sr]", row(f, "wall").channels[0].contrast, -hidden, 0.02, "what it hides, at its own range");
}

// The same bits every time, however many work at it.
TEST(TruthTable, IsTheSameEveryTime) {
  const Simulation sim = scene("background: {temperature: 290 K}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.3}]}}\nentities: [{name: ball, shape: {model: sphere, radius: 2 m}, material: m, "
                               "temperature: 400 K, position: [300 m, 0 m, 0 m]}]\n" + camera(""));
  needContext();
  const TruthMeter meter(sim, sim.cameras[0]);
  const WorldState state = advance(sim, 0.0);
  const double first = meter.targets(state)[0].channels[0].own;
  for (int k = 0; k < 8; ++k) EXPECT_EQ(meter.targets(state)[0].channels[0].own, first);
}

// What a lens brings onto the film from beyond a pinhole's is on it.
TEST(TruthTable, FollowsTheLens) {
  const Frame f = renderFrame(scene("background: {temperature: 3 K}\nmaterials: {m: {components: []}}\nentities: [{name: ball, shape: {model: sphere, radius: 5 m}, material: m, temperature: 500 K, position: [1000 m, 0 m, 262 m]}]\n"
                                    "cameras: [{name: c, film: {width: 64, height: 48, pitch: 20 um}, focal_length: 2 mm, aperture: 1 mm, position: [0 m, 0 m, 0 m], heading: 90 deg, truth: [targets], stages: [{stage: distortion, "
                                    "k1: -0.4}], channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}}]}]\n"));
  const TargetRow& t = row(f, "ball");
  const double r = 0.262, rd = r * (1.0 - 0.4 * r * r);
  EXPECT_NEAR(t.row, 24.0 - rd * 100.0, 1e-3);
  ASSERT_LT(t.row, 24.0);
  EXPECT_GT(t.row, -2.0);
  EXPECT_EQ(t.visible > 0.0, t.bottom > 0.0);
}

// A lamp is its own intensity times the air's transmittance.
TEST(TruthTable, Lamps) {
  const Frame f = renderFrame(scene("atmosphere: {model: homogeneous, extinction: 0.2 /km, temperature: 288 K}\nlights: [{name: flare, intensity: {wavelength: um, unit: W/(sr um), values: [[3, 100], [5, "
                                    "100]]}, position: [3000 m, 0 m, 0 m]}]\n" +
                                    camera("")));
  figure("intensity of a flare through 3 km [W/sr]", row(f, "flare").channels[0].contrast, 130.0 * std::exp(-0.6), 1e-5, "I tau");
  EXPECT_EQ(row(f, "flare").kind, "lamp");
}

// Terms of a pixel add up to it; each is what it says.
TEST(TruthTable, TermsAddUp) {
  const Frame f = renderFrame(scene(
      "atmosphere: {model: homogeneous, extinction: 0.1 /km, temperature: 280 K}\nbackground: {temperature: 250 K}\nambient: {temperature: 270 K}\nsun: {azimuth: 200 deg, elevation: 40 deg, irradiance: 10 W/(m2 um)}\n"
      "materials: {m: {components: [{reflection: lambertian, reflectance: 0.3}]}, g: {medium: gas, absorption: 0.2 /m}}\nlights: [{name: lamp, visible: false, intensity: {wavelength: um, unit: W/(sr "
      "um), values: [[3, 1e5], [6, 1e5]]}, position: [900 m, 0 m, 30 m]}]\nentities:\n- {name: wall, shape: {model: plate, width: 8 m, height: 8 m}, material: m, temperature: 320 K, position: "
      "[1000 m, 0 m, 0 m], heading: 270 deg}\n- {name: puff, shape: {model: sphere, radius: 2 m}, material: g, temperature: 500 K, position: [950 m, 3 m, 0 m]}\n" +
      camera("")));
  double worst = 0.0, most = 0.0;
  const auto& whole = layer(f, "mw.radiance").pixels;
  std::vector<double> sums(whole.size(), 0.0);
  int parts = 0;
  for (const FrameLayer& l : f.layers) {
    if (!l.name.starts_with("truth.terms.mw.")) continue;
    ++parts;
    for (size_t p = 0; p < sums.size(); ++p) sums[p] += static_cast<double>(l.pixels[p]);
  }
  EXPECT_EQ(parts, 7) << "emission, ambient, sun, air, background, media, a lamp's";
  for (size_t p = 0; p < sums.size(); ++p) most = std::max(most, static_cast<double>(whole[p]));
  int off = 0;
  for (size_t p = 0; p < sums.size(); ++p) {
    const double error = std::abs(sums[p] - static_cast<double>(whole[p])) / most;
    if (error > 1e-4) ++off;  // an outline, on which a ray and the rasteriser may see different things
    else worst = std::max(worst, error);
  }
  bound("sum of a pixel's terms against its radiance, of the brightest", worst, 2e-5, "double against single precision");
  bound("pixels on outlines that differ", off, 40.0, "of 12288");
  const double tau = std::exp(-0.1);
  figure("emission of a wall through 1 km of air", at(layer(f, "truth.terms.mw.emission"), f, 64, 48), 0.7 * blackBodyBand(3.6, 4.9, 320.0) * tau, 1e-4, "e B tau");
  figure("ambient light that it reflects", at(layer(f, "truth.terms.mw.ambient"), f, 64, 48), 0.3 * blackBodyBand(3.6, 4.9, 270.0) * tau, 1e-4, "rho B tau");
}

}  // namespace
}  // namespace pitviper::test
