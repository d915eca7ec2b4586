// Pixels that take a program with the sun alone, where no lamp reaches and nothing may stand before the sun, against the reference: films of 64 x 64 have such
// programs. Each scene is one in which leaving lights or shadows out would show.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Balls of a few pixels are drawn in views of their own: the reference works out every sample of these.
Frame drawn(const std::string& scenario) {
  Simulation sim = scene(scenario);
  sim.cameras[0].zoomedSamples = 32;
  return renderFrame(sim);
}

/// The reference's picture of a scenario, once however many are held against it.
const Frame& exactly(const std::string& scenario) {
  static std::map<std::string, Frame> known;
  const auto at = known.find(scenario);
  return at != known.end() ? at->second : known.emplace(scenario, drawn("accuracy: reference\n" + scenario)).first->second;
}

/// The largest difference of a layer from the reference's, by the reference's largest value.
double worst(const std::string& scenario, const std::string& name, const std::string& reference = "") {
  const Frame planned = drawn("accuracy: 1 %\n" + scenario);
  const Frame& exact = exactly(reference.empty() ? scenario : reference);
  const auto &a = layer(planned, name), &b = layer(exact, name);
  double most = 0.0, off = 0.0;
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 64; ++column) {
      const double is = static_cast<double>(at(a, planned, column, row)), should = static_cast<double>(at(b, exact, column, row));
      most = std::max(most, std::abs(should));
      off = std::max(off, std::abs(is - should));
    }
  return off / most;
}

const char* kFilm = "film: {width: 64, height: 64, pitch: 24 um}, focal_length: 1.8 mm, aperture: 1.8 mm";

// A pole 6 km before a wall; of the sun's disc a part is above the horizon, which stands higher than its middle.
TEST(LightDemand, ShadowOfASunPartlySet) {
  const std::string scenario =
      std::string(
          "origin: {latitude: 0 deg, longitude: 0 deg, height: 0 m}\natmosphere: clear_us76\nsun: {azimuth: 180 deg, elevation: -0.35 deg, "
          "temperature: 5772 K}\nentities: [{name: pole, shape: {model: box, length: 20 m, width: 20 m, height: 40 m}, material: "
          "grey_aircraft_paint, temperature: 300 K, position: [0 m, -6000 m, 60 m]}, {name: wall, shape: {model: plate, width: 200 m, "
          "height: 100 m}, material: grey_aircraft_paint, temperature: 300 K, position: [0 m, 0 m, 50 m], heading: 180 deg}]\n"
          "cameras: [{name: c, position: [60 m, -120 m, 60 m], heading: -26 deg, pitch: 0 deg, ") +
      kFilm + ", channels: [{name: sw, response: {band: [1.5 um, 1.8 um]}}]}]\n";
  bound("shadow of a pole in a sun partly set, of the brightest pixel", worst(scenario, "sw.radiance"), 0.01, "the accuracy asked for");
}

std::string lamps(const std::string& sun, const std::string& truth) {
  return sun +
         "lights: [{name: weak, intensity: {wavelength: um, unit: W/(sr um), outside: zero, values: [[1, 0.5], [13, 0.5]]}, position: [4 m, 55 m, 3 m]}, "
         "{name: "
         "strong, intensity: {wavelength: um, unit: W/(sr um), outside: zero, values: [[1, 30], [13, 30]]}, position: [-15 m, 70 m, 3 m]}]\nentities: [{name: "
         "hills, shape: {model: terrain, size: 400 m, relief: 6 m, columns: 80, terrain_seed: 4}, material: dry_grass, temperature: 294 K, position: [0 m, 60 "
         "m, -3 m]}, {name: ball, shape: {model: sphere, radius: 4 m}, material: grey_aircraft_paint, temperature: 300 K, position: [-6 m, 60 m, 5 m]}]\n"
         "cameras: [{name: c, position: [0 m, 0 m, 25 m], heading: 1 deg, pitch: -16 deg, " +
         kFilm + truth + ", channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}}]}]\n";
}

// Two lamps over hills, in sunshine and without: their reach, and the truth of the first, which is there where its light does not matter.
TEST(LightDemand, LampsAndTheirTruth) {
  const std::string truth = ", truth: [solid_angles]", sun = "sun: {azimuth: 200 deg, elevation: 35 deg, temperature: 5772 K}\n";
  for (const auto& [words, day] : {std::pair("in sunshine", sun), std::pair("without a sun", std::string())}) {
    bound(std::string("lamps over hills ") + words + ", of the brightest pixel", worst(lamps(day, ""), "mw.radiance"), 0.01, "the accuracy asked for");
    bound(std::string("solid angle from the first lamp ") + words + ", of the largest", worst(lamps(day, truth), "truth.solid_angle_from_light"), 1e-4,
          "single precision of a grazing facet");
  }
}

/// Balls in a row before a wall, another wall hidden behind it, and lamps on the camera's side of them.
std::string casters(int balls, const std::string& more, const std::string& places) {
  std::string lights, bodies;
  int number = 0;
  for (std::size_t from = 0; from < places.size(); from = places.find(';', from) + 1) {
    lights += (number ? ", " : "") + std::string("{name: l") + std::to_string(number) +
              ", intensity: {wavelength: um, unit: W/(sr um), outside: zero, values: [[1, 3000], [13, 3000]]}, visible: false, position: [" +
              places.substr(from, places.find(';', from) - from) + "]}";
    ++number;
  }
  for (int i = 0; i < balls; ++i)
    bodies += ", {name: ball" + std::to_string(i) + ", shape: {model: sphere, radius: 2 m}, material: grey_aircraft_paint, temperature: 300 K, position: [" +
              std::to_string(-18 + 36 * i / std::max(balls - 1, 1)) + " m, " + std::to_string(52 + i % 3) + " m, " + std::to_string(14 + 5 * (i % 4)) + " m]}";
  return more + "lights: [" + lights + "]\nentities: [{name: wall, shape: {model: plate, width: 60 m, height: 60 m}, material: grey_aircraft_paint, " +
         "temperature: 300 K, position: [0 m, 60 m, 20 m], heading: 180 deg}, {name: hidden, shape: {model: plate, width: 60 m, height: 60 m}, material: " +
         "grey_aircraft_paint, temperature: 320 K, position: [0 m, 61 m, 20 m], heading: 180 deg}" + bodies +
         "]\ncameras: [{name: c, position: [0 m, 0 m, 20 m], heading: 0 deg, " + kFilm + ", channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}}]}]\n";
}

// Where nothing stands before a lamp shadows are not asked for: of the few balls on the line to it they are, of many everywhere.
TEST(LightDemand, WhatStandsBeforeALamp) {
  const std::string sun = "sun: {azimuth: 200 deg, elevation: 35 deg, temperature: 5772 K}\n", one = "10 m, 30 m, 25 m;", two = one + "-14 m, 45 m, 10 m;";
  struct Row {
    const char* what;
    int balls;
    std::string more, lamps;
  };
  for (const Row& r : {Row{"no ball, one lamp", 0, "", one}, Row{"a ball, one lamp", 1, "", one}, Row{"five balls, two lamps", 5, "", two},
                       Row{"five balls, two lamps, sunshine", 5, sun, two}, Row{"twenty balls, one lamp", 20, "", one},
                       Row{"four balls, six lamps", 4, "", two + "0 m, 40 m, 20 m; -5 m, 30 m, 30 m; 15 m, 40 m, 12 m; 3 m, 20 m, 8 m;"}}) {
    const std::string scenario = casters(r.balls, r.more, r.lamps);
    bound(std::string("shadows before a wall, ") + r.what + ", of the brightest pixel", worst(scenario, "mw.radiance"), 0.01, "the accuracy asked for");
    if (r.balls > 0) {
      EXPECT_GT(worst("render: {shadows: false}\n" + scenario, "mw.radiance", scenario), 0.02)
          << r.what << ": without shadows the picture is off by twice what the bound allows";
    }
  }
}

}  // namespace
}  // namespace pitviper::test
