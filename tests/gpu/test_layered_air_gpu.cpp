// Layered air on the GPU, which reads tables made for a view, against the reference pixel in double precision, which integrates along each ray.
#include <gtest/gtest.h>

#include <map>

#include "scenarios/commands/commands.hpp"
#include "sim/plan/planner.hpp"
#include "sim/run/run.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string channels(double low, double high) {
  return "channels: [{name: a, response: {band: [" + std::to_string(low) + " um, " + std::to_string(high) + " um]}}]";
}

// Ground, bodies near and far, sky; looking down, level and up; with and without sun and lights.
TEST(LayeredAir, TablesAgainstRays) {
  double worst = 0.0;
  for (const auto& [low, high] : {std::pair{0.5, 0.7}, {3.6, 4.9}, {8.0, 12.0}})
    for (const double height : {300.0, 6000.0})
      for (const char* mode : {"direct", "buffered"}) {
        // Both modes read the same tables by the same functions: each height and band once in buffered mode.
        if (*mode == 'b' && (low > 3.0 && low < 4.0) != (height > 1000.0)) continue;
        const auto sim = scene(
            "atmosphere: hazy_us76\nsun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}\nambient: {from: sky}\nrender: {mode: " + std::string(mode) +
            "}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.35}]}}\n"
            "lights: [{name: l, intensity: {blackbody: 2500 K, area: 1 m2}, position: [0 m, 5 km, 800 m], visible: false}]\n"
            "entities:\n  - {name: ground, shape: {model: plate, width: 80 km, height: 80 km}, material: m, temperature: 290 K, pitch: 90 deg}\n"
            "  - {name: near, shape: {model: sphere, radius: 10 m}, material: m, temperature: 320 K, position: [0 m, 150 m, " +
            std::to_string(height) +
            " m]}\n"
            "  - {name: far, shape: {model: sphere, radius: 900 m}, material: m, temperature: 270 K, position: [2 km, 25 km, 7 km]}\n"
            "cameras: [{name: c, film: {width: 48, height: 48}, field_of_view: 40 deg, aperture: 5 mm, position: [0 m, 0 m, " +
            std::to_string(height) + " m], look_at: [0 m, 10 km, 2 km], " + channels(low, high) + "}]\n");
        const Worst w = compare(sim, 3);
        EXPECT_GT(w.covered, 200);
        worst = std::max(worst, w.error);
      }
  bound("layered air by tables against rays, 0.1 to 60 km, worst pixel", worst, 5e-3,
        "129 elevations, 193 ranges, 5 azimuths, linear between: curvature of the sky and of ln density");
}

// A plan's tables are as large as its accuracy needs, and lose no more than it says: near and far things in fog, a twilight sky, a wide field at a low sun.
TEST(LayeredAir, PlannedTablesLoseNoMoreThanTheyAreSaidTo) {
  struct Case {
    const char *name, *accuracy, *air, *sun, *field, *band;
  };
  for (const Case& c : {Case{"fog", "0.5 %", "{library: hazy_us76, visibility: 0.7 km}", "50 deg", "20 deg", "[0.5 um, 0.52 um]"},
                        Case{"low sun", "2 %", "hazy_us76", "3 deg", "50 deg", "[0.6 um, 0.62 um]"},
                        Case{"twilight", "5 %", "clear_us76", "-0.8 deg", "10 deg", "[0.5 um, 0.53 um]"},
                        Case{"heat", "1 %", "hazy_mls", "40 deg", "30 deg", "[4.2 um, 4.9 um]"}}) {
    const auto sim = scene("atmosphere: " + std::string(c.air) + "\nsun: {azimuth: 40 deg, elevation: " + c.sun +
                           ", temperature: 5772 K}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.35}]}}\nentities:\n"
                           "  - {name: ground, shape: {model: plate, width: 80 km, height: 80 km}, material: m, temperature: 290 K, pitch: 90 deg}\n"
                           "  - {name: near, shape: {model: sphere, radius: 0.4 m}, material: m, temperature: 320 K, position: [-1 m, 9 m, 12 m]}\n"
                           "  - {name: far, shape: {model: sphere, radius: 900 m}, material: m, temperature: 270 K, position: [2 km, 25 km, 1 km]}\n"
                           "cameras: [{name: c, film: {width: 32, height: 32}, field_of_view: " +
                           std::string(c.field) +
                           ", aperture: 5 mm, position: [0 m, 0 m, 12 m], look_at: [0 m, 10 km, 200 m], channels: [{name: a, response: {band: " + c.band +
                           "}}]}]\naccuracy: " + c.accuracy + "\n");
    const Plan plan = planFor(sim, {&sim.cameras[0], nullptr});
    const Worst w = compare(sim, plan, 3, 1e-3);
    EXPECT_GT(w.covered, 100);
    EXPECT_LT(plan.parts[0].tables, plan.accuracy) << c.name;
    bound(std::string("tables of air, ") + c.name + ", planned at " + c.accuracy + ", worst pixel", w.error, plan.parts[0].tables + plan.parts[0].precision,
          "what the plan says of them");
  }
}

// A camera that climbs and sinks again: neighbouring frames share tables, and still none depends on those drawn before it.
TEST(LayeredAir, NoFrameDependsOnThoseBeforeIt) {
  const auto sim = scene(
      "atmosphere: hazy_us76\nsun: {azimuth: 60 deg, elevation: 20 deg, temperature: 5772 K}\ntime: {rate: 10 Hz, frames: 12}\naccuracy: 1 %\naudit: "
      "0\nentities:\n"
      "  - {name: ground, shape: {model: plate, width: 40 km, height: 40 km}, material: dry_grass, temperature: 290 K, pitch: 90 deg}\n"
      "  - {name: lift, shape: {model: box, length: 1 m, width: 1 m, height: 1 m}, material: concrete, temperature: 290 K, motion: [{time: 0 s, position: [0 "
      "m, 0 m, "
      "50 m]}, {time: 0.6 s, position: [3 m, 1 m, 95 m], heading: 2 deg}, {time: 1.2 s, position: [4 m, 1 m, 60 m], heading: 2 deg}]}\n"
      "cameras: [{name: c, film: {width: 24, height: 24}, field_of_view: 12 deg, aperture: 5 mm, attached_to: lift, channels: [{name: a, response: {band: [3.7 "
      "um, "
      "4.8 um]}}, {name: b, response: {band: [0.5 um, 0.52 um]}}]}]\n");
  const auto framesOf = [&](RunRange range) {
    std::map<int, Frame> frames;
    runFrames(sim, shaderLibrary(), range, [&](const auto& f) { frames[f->number] = *f; });
    return frames;
  };
  const auto all = framesOf({0, 11});
  for (int number : {3, 7, 11}) {
    const auto alone = framesOf({number, number});
    for (size_t l = 0; l < all.at(number).layers.size(); ++l) EXPECT_EQ(all.at(number).layers[l].pixels, alone.at(number).layers[l].pixels) << number;
  }
}

}  // namespace
}  // namespace pitviper::test
