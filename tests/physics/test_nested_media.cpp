// Media in each other: absorption and emission add where they overlap. Held against the slab equation layer by layer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/gl/context.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

struct Slab {
  double depth, temperature_K, share = 1.0, other_K = 0.0;  ///< share of the depth at the first temperature, the rest at the other
};

/// Nearest first, grey, before a background at 0 K [W/(m2 sr)].
double radianceOf(const std::vector<Slab>& slabs, double low_um, double high_um) {
  double sum = 0.0, through = 1.0;
  for (const Slab& s : slabs) {
    const double source =
        s.share * blackBodyBand(low_um, high_um, s.temperature_K) + (s.share < 1.0 ? (1.0 - s.share) * blackBodyBand(low_um, high_um, s.other_K) : 0.0);
    sum += through * source * -std::expm1(-s.depth);
    through *= std::exp(-s.depth);
  }
  return sum;
}

std::string world(const std::string& materials, const std::string& entities, const std::string& more = "") {
  return "materials:\n" + materials + "entities:\n" + entities + more +
         "cameras:\n  - name: c\n    film: {width: 31, height: 31}\n    field_of_view: 8 deg\n    small_bodies: 0\n    aperture: 10 mm\n    position: [0 m, 0 "
         "m, 0 m]\n    heading: "
         "0 deg\n"
         "    channels: [{name: mw, response: {band: [4 um, 5 um]}}]\n";
}

double middle(const std::string& yaml) {
  const Frame f = renderFrame(scene(yaml));
  return at(layer(f, "mw.radiance"), f, 15, 15);
}

TEST(NestedMedia, CoreInASheath) {
  const std::string materials = "  g: {absorption: 0.5 /m}\n  thin: {absorption: 0.1 /m}\n";
  const std::string sheath = "  - {name: sheath, shape: {model: sphere, radius: 2 m}, material: thin, temperature: 600 K, position: [0 m, 50 m, 0 m]}\n";
  const std::string core = "  - {name: core, shape: {model: sphere, radius: 0.5 m}, material: g, temperature: 1500 K, position: [0 m, 50.5 m, 0 m]}\n";
  // Along the axis: 2 m of sheath alone, 1 m of both, 1 m of sheath.
  const double expected = radianceOf({{0.2, 600}, {0.6, 600, 1.0 / 6.0, 1500}, {0.1, 600}}, 4, 5);
  figure("core in a sheath [W/(m2 sr)]", middle(world(materials, sheath + core)), expected, 1e-5, "slab equation of three layers; single precision");
  figure("core in a sheath, the core first in the file [W/(m2 sr)]", middle(world(materials, core + sheath)), expected, 1e-5,
         "slab equation of three layers; single precision");
  const std::string pane =
      "  - {name: pane, shape: {model: plate, width: 3 m, height: 3 m}, material: {transmission: {transmittance: 0.4}, emission: {emissivity: 0}}, "
      "temperature: 0 K, position: [0 m, 30 m, 0 m], heading: 0 deg}\n";
  figure("core in a sheath behind a pane [W/(m2 sr)]", middle(world(materials, core + pane + sheath)), 0.4 * expected, 1e-5, "the same, times 0.4");
}

TEST(NestedMedia, PuffsGrownIntoEachOther) {
  std::string puffs, lone;
  std::vector<Slab> slabs;
  // Spheres of 1 m along the line of sight, 1.5 m apart: 1 m of each alone, 0.5 m of two; the outer ends 0.5 m longer.
  for (int i = 0; i < 7; ++i)
    puffs += "  - {name: p" + std::to_string(i) + ", shape: {model: sphere, radius: 1 m}, material: g, temperature: " + std::to_string(400 + 100 * i) +
             " K, position: [0 m, " + std::to_string(50.0 + 1.5 * i) + " m, 0 m]}\n";
  slabs.push_back({0.3 * 0.5, 400});
  for (int i = 0; i < 7; ++i) {
    slabs.push_back({0.3 * 1.0, 400.0 + 100 * i});
    slabs.push_back(i < 6 ? Slab{0.6 * 0.5, 400.0 + 100 * i, 0.5, 500.0 + 100 * i} : Slab{0.3 * 0.5, 1000});
  }
  figure("seven puffs grown into each other [W/(m2 sr)]", middle(world("  g: {absorption: 0.3 /m}\n", puffs)), radianceOf(slabs, 4, 5), 1e-5,
         "slab equation of fifteen layers; single precision");
}

// Drivers without a GPU end a program's loops after so many rounds, without a word: what is too much for them is refused with one.
TEST(NestedMedia, HundredsOnALine) {
  const std::string wall =
      "  - {name: wall, shape: {model: plate, width: 30 m, height: 30 m}, material: blackbody, temperature: 600 K, position: [0 m, 900 m, 0 m], heading: 0 "
      "deg}\n";
  const auto panes = [&](int count) {
    std::string all;
    for (int i = 0; i < count; ++i)
      all += "  - {name: p" + std::to_string(i) + ", shape: {model: plate, width: 9 m, height: 9 m}, material: pane, temperature: 0 K, position: [0 m, " +
             std::to_string(50.0 + 0.5 * ((i * 13) % count)) + " m, 0 m], heading: 0 deg}\n";
    return all;
  };
  const std::string pane = "  pane: {transmission: {transmittance: 0.995}, emission: {emissivity: 0}}\n", thin = "  g: {absorption: 0.01 /m}\n";
  figure("wall behind 700 panes [W/(m2 sr)]", middle(world(pane, wall, panes(700))), std::pow(0.995, 700) * blackBodyBand(4, 5, 600), 2e-4,
         "T^700; single precision of 0.995, 3e-8, 700 times, and of as many products");
  std::string balls;
  for (int i = 0; i < 60; ++i)
    balls += "  - {name: b" + std::to_string(i) + ", shape: {model: sphere, radius: " + std::to_string(0.05 * (i + 1)) +
             " m}, material: g, temperature: 0 K, position: [0 m, 100 m, 0 m]}\n";
  figure("wall behind 60 balls in each other [W/(m2 sr)]", middle(world(thin, wall, balls)), std::exp(-0.01 * 0.1 * 60 * 61 / 2) * blackBodyBand(4, 5, 600),
         1e-4, "exp(-k d) of all diameters; single precision of 119 pieces");
  needContext();
  if (!isSoftware()) GTEST_SKIP() << "a GPU takes as many as there are";
  EXPECT_THROW(middle(world(pane, wall, panes(1100))), GlError);
}

TEST(NestedMedia, WholePictureAgainstDouble) {
  const std::string materials =
      "  gas: {absorption: {wavelength: um, unit: 1/m, values: [[2.9, 0.1], [4.2, 3], [5.2, 0.2]]}}\n  smoke: {absorption: 0.4 /m, radiance: 0.2 W/(m2 sr "
      "um)}\n";
  const std::string entities =
      "  - {name: wall, shape: {model: plate, width: 30 m, height: 30 m}, material: sand, temperature: 310 K, position: [0 m, 40 m, 0 m], heading: 70 deg}\n"
      "  - {name: sheath, shape: {model: cone, radius: 1 m, top_radius: 0.3 m, length: 6 m}, material: gas, temperature: 600 K, position: [0 m, 30 m, 0 m], "
      "heading: 40 deg}\n"
      "  - {name: core, shape: {model: cylinder, radius: 0.3 m, length: 7 m}, material: gas, temperature: 1400 K, position: [0.2 m, 30 m, 0.1 m], heading: 40 "
      "deg}\n"
      "  - {name: puff, shape: {model: ellipsoid, length: 3 m, width: 2 m, height: 1 m}, material: smoke, temperature: 290 K, position: [-1 m, 28 m, -0.5 m]}\n"
      "  - {name: body, shape: {model: sphere, radius: 0.4 m}, material: sand, temperature: 350 K, position: [-0.5 m, 29 m, -0.3 m]}\n";
  const Worst w = compare(scene(world(materials, entities, "atmosphere: {extinction: 20 /km, temperature: 285 K}\n")), 1);
  EXPECT_GT(w.covered, 800);
  bound("media in each other, with a body inside and air, GPU float against CPU double, 99 % of pixels", w.percentile99, 1e-5, "single precision");
  bound("media in each other, with a body inside and air, worst pixel", w.error, 1e-3, "a silhouette moved by 1e-5 pixel");
}

}  // namespace
}  // namespace pitviper::test
