// Shadows of lamps are looked for to the distance at which they matter at the accuracy asked for, and not beyond: near by they are there, far off what is
// lit though it should be dark is less than its part of the accuracy.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/plan/budget.hpp"
#include "sim/plan/planner.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

struct Kind {
  const char* name;
  const char* material;
  const char* temperature;
};

// A row, and tables: textures of reflection and temperature, a lobe, an emissivity of its own.
constexpr Kind kKinds[] = {{"grey", "{components: [{reflection: lambertian, reflectance: 0.3}]}", "300 K"},
                           {"textured and glossy",
                            "{components: [{reflection: lambertian, reflectance: 0.3, modifier: {rows: [[0.4, 1], [1, 0.4]]}}, {reflection: phong, "
                            "reflectance: 0.2, exponent: 10}]}",
                            "{rows: [[290 K, 310 K], [310 K, 290 K]]}"},
                           {"of little emission", "{components: [{reflection: lambertian, reflectance: 0.3}], emission: {emissivity: 0.1}}", "300 K"}};

/// Radiance of a plate `distance_m` below a lamp, a screen before the lamp; another, nearby, keeps lamps in the plan.
double plate(const Kind& kind, double distance_m, bool shadows, double level, const std::string& light) {
  const Simulation sim =
      scene(std::string("accuracy: 5 %\nrender: {shadows: ") + (shadows ? "true" : "false") + "}\n" + light + "materials: {m: " + kind.material +
            ", black: {components: [{reflection: lambertian, reflectance: 0.01}]}}\nlights: [{name: lamp, intensity: {blackbody: 2500 K, area: 0.001 m2}, "
            "visible: false, level: [[-1 s, " +
            print("%g", level) + "], [1 s, " + print("%g", level) + "]], position: [0 m, 0 m, " + print("%.9g", distance_m) +
            " m]}, {name: near, intensity: {blackbody: 2500 K, area: 2e-6 m2}, visible: false, position: [0 m, 0 m, 0.3 m]}]\nentities:\n- {name: plate, "
            "shape: {model: plate, width: 1 m, height: 1 m}, material: m, temperature: " +
            kind.temperature +
            ", heading: 0 deg, pitch: 90 deg, position: [0 m, 0 m, 0 m]}\n- {name: screen, shape: {model: plate, width: 40 m, height: 40 m}, material: black, "
            "temperature: 300 K, "
            "heading: 0 deg, pitch: 90 deg, position: [0 m, 0 m, " +
            print("%.9g", 0.9 * distance_m) +
            " m]}\ncameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 10 deg, aperture: 10 mm, position: [1.5 m, 0 m, 0.3 m], look_at: plate, "
            "channels: [{name: mw, response: "
            "{band: [3.6 um, 4.6 um]}}]}]\n");
  const Frame f = renderFrame(sim);
  return at(layer(f, "mw.radiance"), f, 4, 4);
}

TEST(LampShadows, ReachAsFarAsTheyMatter) {
  constexpr double kAccuracy = 0.05;
  for (const char* light : {"", "ambient: {temperature: 280 K}\n"})
    for (const Kind& kind : kKinds) {
      int shaded = 0, open = 0;
      double worst = 0.0;
      for (double distance : {0.5, 48.0, 68.0, 96.0, 136.0, 192.0, 272.0, 384.0}) {
        const double dark = plate(kind, distance, true, 0.0, light), drawn = plate(kind, distance, true, 1.0, light), off = std::abs(drawn - dark);
        if (off < 2e-6 * dark || off < 1e-4 * (plate(kind, distance, false, 1.0, light) - dark) + 2e-6 * dark) {
          ++shaded;
        } else {
          ++open;
          worst = std::max(worst, (drawn - dark) / dark);
        }
      }
      EXPECT_GT(shaded, 0) << kind.name << ": at the shortest distance the lamp is a good part of the pixel";
      EXPECT_GT(open, 0) << kind.name << ": at the longest it is nothing";
      bound(std::string("light of a lamp that no shadow was looked for, ") + kind.name + (*light ? ", beside ambient light" : "") + ", of the pixel", worst,
            budget::kLampShadows.share * kAccuracy / 2.0 * 1.001, "budget::kLampShadows of 5 %, half for each of two lamps");
    }
}

// A lamp that is left out is a hundredth of the accuracy at most. Expected: of a grey plate, albedo 0.3, the reflection of an isotropic lamp straight above, by
// the inverse square law, beside its emission; the plate's middle, 0.3 of Planck's law integrated over the band.
TEST(LampShadows, LampsReachAsFarAsTheyMatter) {
  constexpr double kAccuracy = 0.05, kLow_um = 3.6, kHigh_um = 4.6;
  double lamp_W_sr = 0.0, own = 0.0;
  constexpr int kSteps = 2000;
  for (int n = 0; n < kSteps; ++n) {
    const double um = kLow_um + (n + 0.5) * (kHigh_um - kLow_um) / kSteps, step = (kHigh_um - kLow_um) / kSteps;
    lamp_W_sr += 0.001 * physics::planckRadiance(um, 2500.0) * step;
    own += 0.7 * physics::planckRadiance(um, 300.0) * step;
  }
  int kept = 0, left = 0;
  double worst = 0.0, off = 0.0;
  for (double distance : {4.0, 48.0, 68.0, 96.0, 114.0, 136.0, 162.0, 192.0, 384.0}) {
    const double dark = plate(kKinds[0], distance, false, 0.0, ""), found = plate(kKinds[0], distance, false, 1.0, "") - dark;
    const double expected = 0.3 / kPi * lamp_W_sr / (distance * distance);
    if (found > 0.0) {
      ++kept;
      off = std::max(off, std::abs(found - expected) / dark);
    } else {
      ++left;
      worst = std::max(worst, expected / own);
    }
  }
  EXPECT_GT(kept, 2);
  EXPECT_GT(left, 1);
  bound("light of a lamp that was left out, of the pixel", worst, budget::kLamps.share * kAccuracy / 2.0 * 1.001,
        "budget::kLamps of 5 %, half for each of two lamps");
  bound("light of one that was not, off by, of the pixel", off, kAccuracy, "the accuracy asked for");
}

// Plans say so beforehand.
TEST(LampShadows, WhatIsNotLookedForIsPredicted) {
  const auto dropped = [](const char* shadows) {
    const Simulation sim =
        scene(std::string("accuracy: 5 %\nrender: {shadows: ") + shadows +
              "}\nlights: [{name: lamp, intensity: {blackbody: 2500 K, area: 1 m2}, visible: false, position: [0 m, 0 m, 3 m]}]\nentities: [{name: ball, "
              "shape: {model: "
              "sphere, radius: 1 m}, material: {components: [{reflection: lambertian, reflectance: 0.3}]}, temperature: 300 K}, {name: screen, "
              "shape: {model: plate, width: 1 m, height: 1 m}, material: blackbody, temperature: 300 K, position: [0 m, 3 m, 2 m]}]\ncameras: [{name: c, film: "
              "{width: 8, "
              "height: 8}, field_of_view: 10 deg, aperture: 10 mm, position: [9 m, 0 m, 3 m], look_at: ball, channels: [{name: mw, response: {band: [3.6 um, "
              "4.6 um]}}]}]\n");
    return planFor(sim, {&sim.cameras[0], nullptr}).parts[0].dropped;
  };
  figure("predicted of shadows of lamps at 5 %", dropped("true") - dropped("false"), budget::kLampShadows.share * 0.05, 1e-9,
         "budget::kLampShadows of the accuracy");
}

}  // namespace
}  // namespace pitviper::test
