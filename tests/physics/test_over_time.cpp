// Things over time through the whole pipeline: temperatures by courses, bodies that come and go, lamps, zooms.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string camera(const std::string& keys = "position: [10 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m]") {
  return "cameras: [{name: c, film: {width: 24, height: 24}, field_of_view: 12 deg, aperture: 20 mm, " + keys +
         ", channels: [{name: mw, response: {band: [3 um, 5 um]}}, {name: lw, response: {band: [8 um, 12 um]}}]}]\n";
}

// Rationale: a black plate sends its own band radiance at the temperature that its course has, at each of three times; also by a plan, which was made for all
// of them.
TEST(OverTime, APlateFollowsItsCourse) {
  for (const auto& [accuracy, allowed] : {std::pair<std::string, double>{"", 2e-6}, {"accuracy: 1 %\n", 0.01}, {"accuracy: reference\n", 5e-5}}) {
    const Simulation sim = scene(accuracy +
                                 "time: {rate: 10 Hz, frames: 11}\n"
                                 "entities: [{name: p, shape: {model: plate, width: 3 m, height: 3 m}, material: blackbody, temperature: [[0 s, 300 K], [0.5 "
                                 "s, 900 K], [1 s, 400 K]]}]\n" +
                                 camera());
    for (const auto& [frame, temperature] : {std::pair{0, 300.0}, {5, 900.0}, {8, 600.0}})
      for (const auto& [name, low, high] : {std::tuple{"mw", 3.0, 5.0}, {"lw", 8.0, 12.0}}) {
        const Frame f = renderFrame(sim, frame);
        figure(accuracy.substr(0, accuracy.size() - (accuracy.empty() ? 0 : 1)) + " " + name + " of a plate on its course, frame " + std::to_string(frame),
               at(layer(f, std::string(name) + ".radiance"), f, 12, 12), blackBodyBand(low, high, temperature), allowed,
               "Planck in band; single precision with 16 Gauss points, the accuracy, or the fine grid, which is good to 1e-5");
      }
  }
}

// A medium too: its own source follows, L = (1 - exp(-k s)) B(T).
TEST(OverTime, AGasFollowsItsCourse) {
  const Simulation sim = scene(
      "time: {rate: 10 Hz, frames: 11}\nmaterials: {gas: {medium: gas, absorption: 0.5 /m}}\n"
      "entities: [{name: g, shape: {model: sphere, radius: 1 m}, material: gas, temperature: [[0 s, 800 K], [1 s, 1200 K]]}]\n" +
      camera());
  for (const auto& [frame, temperature] : {std::pair{0, 800.0}, {5, 1000.0}, {10, 1200.0}}) {
    const Frame f = renderFrame(sim, frame);
    // The four pixels about the middle pass it 0.06 m beside its middle: the chord is 2 m x (1 - 0.002).
    figure("a gas on its course, frame " + std::to_string(frame), at(layer(f, "mw.radiance"), f, 12, 12),
           (1.0 - std::exp(-1.0)) * blackBodyBand(3, 5, temperature), 2e-3, "1 - exp(-k s), s the diameter");
  }
}

/// Everything that a frame says of its channels.
double worst(const Frame& a, const Frame& b, const std::string& name) {
  const auto &x = layer(a, name).pixels, &y = layer(b, name).pixels;
  double most = 0.0;
  for (size_t p = 0; p < x.size(); ++p) most = std::max(most, std::abs(static_cast<double>(x[p]) - static_cast<double>(y[p])));
  return most;
}

// Rationale: what is not there leaves the frame as if it were not in the scenario at all, whatever it is: opaque, transparent, gas, small, a lamp.
TEST(OverTime, WhatIsNotThereLeavesTheBackground) {
  const std::string head =
      "time: {rate: 10 Hz, frames: 10}\nbackground: {temperature: 280 K}\nmaterials: {pane: {components: [{reflection: lambertian, reflectance: 0.1}], "
      "transmission: {transmittance: 0.5}}, "
      "gas: {medium: gas, absorption: 0.5 /m}, m: {components: [{reflection: lambertian, reflectance: 0.5}]}}\n";
  const std::string wall = "  - {name: wall, shape: {model: plate, width: 9 m, height: 9 m}, material: m, temperature: 290 K, position: [-3 m, 0 m, 0 m]}\n";
  const Frame alone = renderFrame(scene(head + "entities:\n" + wall + camera()), 2);
  const std::string place = ", temperature: 700 K, position: [0 m, 0 m, 0 m], begin: 0.5 s";
  const std::vector<std::pair<std::string, std::string>> all = {
      {"opaque", "  - {name: x, shape: {model: sphere, radius: 0.5 m}, material: blackbody" + place + "}\n"},
      {"pane", "  - {name: x, shape: {model: plate, width: 1 m, height: 1 m}, material: pane" + place + "}\n"},
      {"gas", "  - {name: x, shape: {model: sphere, radius: 0.5 m}, material: gas" + place + "}\n"},
      {"small", "  - {name: x, shape: {model: sphere, radius: 2 cm}, material: blackbody" + place + "}\n"},
      {"child", "  - {name: y, shape: {model: sphere, radius: 0.1 m}, material: blackbody" + place +
                    "}\n  - {name: x, shape: {model: sphere, radius: 0.3 m}, material: blackbody, "
                    "temperature: 500 K, attached_to: y}\n"}};
  for (const auto& [what, entity] : all) {
    const Simulation sim = scene(head + "entities:\n" + wall + entity + camera());
    const Frame before = renderFrame(sim, 2), after = renderFrame(sim, 7);
    for (const char* name : {"mw.radiance", "lw.radiance"}) {
      EXPECT_EQ(worst(before, alone, name), 0.0) << what;
      EXPECT_GT(worst(after, alone, name), 1e-3) << what;
    }
  }
  const Simulation lit =
      scene(head + "entities:\n" + wall + "lights: [{name: l, intensity: 900 W/(sr um), position: [0 m, 1 m, 0 m], begin: 0.5 s}]\n" + camera());
  // Another program draws a scene with lamps: rounding.
  EXPECT_LT(worst(renderFrame(lit, 2), alone, "mw.radiance"), 1e-5 * at(layer(alone, "mw.radiance"), alone, 2, 2));
  EXPECT_GT(worst(renderFrame(lit, 7), alone, "mw.radiance"), 1.0);
}

// Rationale: a plate between a lamp, or the sun, and the ground shades it as long as it is there, and not before or after.
TEST(OverTime, WhatHasVanishedCastsNoShadow) {
  for (const std::string light :
       {"lights: [{name: l, intensity: 5000 W/(sr um), position: [0 m, 0 m, 6 m]}]\n", "sun: {azimuth: 0 deg, elevation: 89.9 deg, temperature: 5772 K}\n"}) {
    const std::string head = "time: {rate: 10 Hz, frames: 10}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.9}]}}\n" + light +
                             "entities:\n  - {name: floor, shape: {model: box, length: 9 m, width: 9 m, height: 1 m}, material: m, temperature: 0 K, position: "
                             "[0 m, 0 m, -0.5 m]}\n";
    const std::string eye = camera("position: [8 m, 0 m, 3 m], look_at: [0 m, 0 m, 0 m]");
    const std::string hand =
        "  - {name: hand, shape: {model: box, length: 2 m, width: 2 m, height: 0.1 m}, material: m, temperature: 0 K, position: [0 m, 0 m, 4 m]";
    for (const std::string life : {", begin: 0.3 s, end: 0.6 s}\n",
                                   ", ends: vanish, motion: [{time: 0.3 s, position: [0 m, 0 m, 4 m], heading: 90 deg}, {time: 0.5 s, position: [0 m, 0 m, 4 "
                                   "m], heading: 90 deg}]}\n"}) {
      const std::string body = life.find("motion") == std::string::npos ? hand + life : hand.substr(0, hand.find(", position")) + life;
      for (const std::string accuracy : {"", "accuracy: reference\n"}) {
        const Frame alone = renderFrame(scene(accuracy + head + eye), 0);
        const double lit = at(layer(alone, "mw.radiance"), alone, 12, 12);
        ASSERT_GT(lit, 0.0);
        const Simulation sim = scene(accuracy + head + body + eye);
        const auto middle = [&](int frame) {
          const Frame f = renderFrame(sim, frame);
          return at(layer(f, "mw.radiance"), f, 12, 12);
        };
        figure("before it is there", middle(1), lit, 2e-6, "as without it, single precision");
        EXPECT_EQ(middle(4), 0.0) << accuracy << life;
        figure("after it has vanished", middle(7), lit, 2e-6, "as without it, single precision");
      }
    }
  }
}

// Rationale: a body of s metres at d spans s f / (d p) pixels: its flux in a zoom goes with the focal length squared.
TEST(OverTime, AZoomMakesThingsLarger) {
  const Simulation sim = scene(
      "time: {rate: 1 Hz, frames: 3}\nentities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: blackbody, temperature: 500 K, heading: "
      "90 deg}]\n"
      "cameras: [{name: c, film: {width: 64, height: 64, pitch: 20 um}, focal_length: [[0 s, 50 mm], [2 s, 100 mm]], aperture: 20 mm, small_bodies: 0, "
      "samples: 8, position: [100 m, 0 m, 0 m], "
      "look_at: p, channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n");
  const double first = sum(layer(renderFrame(sim, 0), "mw.radiance"));
  // 25 pixels across, each of 8 lines: an edge is told to a sixteenth of a pixel each.
  figure("area of a plate on the film, focal length 1.5 times", sum(layer(renderFrame(sim, 1), "mw.radiance")) / first, 2.25, 0.02,
         "f^2; edges to a line of 8");
  figure("area of a plate on the film, focal length twice", sum(layer(renderFrame(sim, 2), "mw.radiance")) / first, 4.0, 0.02, "f^2; edges to a line of 8");
}

}  // namespace
}  // namespace pitviper::test
