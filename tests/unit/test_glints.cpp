// Lines of sight that planning aims: at glints of lobes of any sharpness, on bodies and on panes, and at bodies below a pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/plan/sight_rays.hpp"
#include "sim/world/glint.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string sphereOf(const std::string& gloss, const std::string& more) {
  return "background: {temperature: 280 K}\nmaterials: {gloss: {" + gloss + "}}\nsun: {azimuth: 222 deg, elevation: 25 deg, temperature: 5772 K}\n" + more +
         "entities: [{name: s, shape: {model: sphere, radius: 2 m, segments: 256}, material: gloss, temperature: 300 K, position: [0.3 m, 1000 m, 0.4 m]}]\n"
         "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.6 deg, aperture: 20 mm, position: [0 m, 0 m, 0 m], heading: 0 deg,\n"
         "  channels: [{name: v, response: {band: [3.6 um, 3.8 um]}}]}]\n";
}

// Within a lobe's width of the mirrored light (1 - cos of sqrt(2 / n) is 1 / n), however few of the lines of a survey come near it.
TEST(Glints, AreFoundWhateverTheirSharpness) {
  for (const double exponent : {20.0, 4e3, 1e6})
    for (const std::string transmission : {"", "transmission: {transmittance: 0.3}, "}) {
      const Simulation sim =
          scene(sphereOf(transmission + "components: [{reflection: phong, exponent: " + std::to_string(exponent) + ", reflectance: 0.5}]", ""));
      SightRays rays(sim, {&sim.cameras[0], nullptr}, 1);
      double least = INFINITY;
      for (const SightRay& r : rays.extremes()) {
        if (!r.glints) continue;
        least = std::min(least, offMirror(sim, *r.state, r.line.hits.solid.entity >= 0 ? r.line.hits.solid : r.line.hits.layers.front(), r.line.direction, 0));
      }
      EXPECT_LT(least, 1.0 / exponent) << exponent << transmission;
    }
}

TEST(Glints, OnlyOfGlossAndOfLightsThatShine) {
  const auto count = [](const Simulation& sim) {
    SightRays rays(sim, {&sim.cameras[0], nullptr}, 1);
    const auto& all = rays.extremes();
    return std::count_if(all.begin(), all.end(), [](const SightRay& r) { return r.glints; });
  };
  const std::string lamp = "lights: [{name: l, intensity: {blackbody: 2500 K, area: 1 m2}, position: [9 m, 900 m, 9 m], visible: false, level: [[0 s, ";
  EXPECT_EQ(count(scene(sphereOf("components: [{reflection: lambertian, reflectance: 0.5}]", ""))), 0);
  EXPECT_EQ(count(scene(sphereOf("components: [{reflection: phong, exponent: 90, reflectance: 0.5}]", lamp + "0]]}]\n"))), 1);
  EXPECT_EQ(count(scene(sphereOf("components: [{reflection: phong, exponent: 90, reflectance: 0.5}]", lamp + "1]]}]\n"))), 2);
}

// One small body among many parts: a body of the film's size is none.
TEST(SmallBodyLines, MeetBodiesBelowAPixel) {
  std::string entities;
  for (int k = 0; k < 200; ++k)
    entities += "  - {name: far" + std::to_string(k) +
                ", shape: {model: box, length: 1 m, width: 1 m, height: 1 m}, material: soot, temperature: 300 K, position: [0 m, -50 m, 0 m]}\n";
  const Simulation sim =
      scene("entities:\n" + entities +
            "  - {name: dot, shape: {model: sphere, radius: 1 cm}, material: soot, temperature: 900 K, position: [0.2 m, 1000 m, 0.1 m]}\n"
            "  - {name: wall, shape: {model: plate, width: 90 m, height: 90 m}, material: soot, temperature: 280 K, position: [0 m, 1100 m, 0 m]}\n"
            "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.6 deg, aperture: 20 mm, position: [0 m, 0 m, 0 m], heading: 0 deg,\n"
            "  channels: [{name: v, response: {band: [3.6 um, 3.8 um]}}]}]\n");
  SightRays rays(sim, {&sim.cameras[0], nullptr}, 1);
  const auto lines = rays.ofSmallBodies(60);
  EXPECT_EQ(lines.size(), 60u);
  for (const SightRay& r : lines) {
    ASSERT_GE(r.line.hits.solid.entity, 0);
    EXPECT_EQ(sim.entities[static_cast<size_t>(r.line.hits.solid.entity)].name, "dot");
  }
}

}  // namespace
}  // namespace pitviper::test
