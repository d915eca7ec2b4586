// Shadows as drawn, by depth maps and rays in single precision, against the reference's rays in double precision, which know no maps.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scenarios/commands/commands.hpp"
#include "sim/gl/context.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/render/direct_pass.hpp"
#include "sim/render/reference/reference_pixel.hpp"
#include "sim/render/shadow/shadow_demand.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Pixels of a picture, and those of them that are lit otherwise than the reference's by more than 1 %.
struct Tally {
  long pixels = 0, wrong = 0, shaded = 0;
  void operator+=(const Tally& t) { pixels += t.pixels, wrong += t.wrong, shaded += t.shaded; }
};

enum class By { Maps, RaysAlone };

Tally tally(const Simulation& sim, int stride = 1, By by = By::Maps) {
  needContext();
  const Camera& camera = sim.cameras[0];
  const Plan plan = makePlan(sim, camera.outputs, camera.spectral, camera.where);
  EXPECT_TRUE(plan.terms.shadows);
  Plan open = plan;
  open.terms.shadows = false;
  const WorldState state = advance(sim, 0.0);
  const View view = cameraView(camera, state, 1);
  auto gpu = std::make_shared<const GpuScene>(sim);
  const auto pass = makeScenePass(sim, plan, shaderLibrary(), gpu, true, camera.pinhole.apertureArea_m2());
  // One subpixel of each body is few enough for rays.
  const std::vector<char> drawn(sim.entities.size(), 1);
  const std::vector<double> few(sim.entities.size(), 1.0);
  const ShadowDemand demand{view, drawn, few};
  pass->setState(state, by == By::Maps ? nullptr : &demand);
  pass->draw(view, state, drawn);
  pass->startReadback();
  const RawImage raw = pass->finishReadback();
  // One of each for all pixels: what they have in common is worked out once.
  const ReferenceShader shaded(sim, plan, view, state, drawn), lit(sim, open, view, state, drawn);
  Tally t;
  for (int y = 0; y < view.height; y += stride)
    for (int x = 0; x < view.width; x += stride) {
      const size_t p = static_cast<size_t>(y * view.width + x);
      const ReferencePixel want = shaded.pixel(x, y);
      const TruthPixel truth = truthAt(raw, p);
      // A silhouette of the picture itself may fall either way.
      if (want.entity < 0 || static_cast<int>(truth.entity) != want.entity + 1 ||
          std::abs(static_cast<double>(truth.range_m) - want.range_m) > 1e-4 * want.range_m)
        continue;
      ++t.pixels;
      t.shaded += lit.pixel(x, y).slots[0] > 1.01 * want.slots[0];
      t.wrong += std::abs(static_cast<double>(raw.groups[0][4 * p]) - want.slots[0]) > 0.01 * want.slots[0];
    }
  return t;
}

std::string number(double v) { return std::to_string(v); }

constexpr const char* kFilm =
    "cameras:\n  - {name: c, film: {width: 64, height: 64}, aperture: 5 mm, small_bodies: 0, channels: [{name: a, response: {band: [3 um, 4 um]}}], ";

// Balls, boxes, cylinders, jets and terrain in all attitudes over a plate, the sun and lights among them.
TEST(ShadowsAgainstDouble, RandomScenes) {
  std::mt19937 random(11);
  auto within = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  auto place = [&](double reach, double low, double high) {
    return "[" + number(within(-reach, reach)) + " m, " + number(within(-reach, reach)) + " m, " + number(within(low, high)) + " m]";
  };
  // Kinds of light, ground and bodies take turns of 3, 4, 5 and 6: so many have all pairs of them.
  constexpr int kScenes = 50;
  Tally all, byRays;
  for (int n = 0; n < kScenes; ++n) {
    std::string y = "materials: {m: {components: [{reflection: lambertian, reflectance: 0.6}]}}\nambient: {temperature: 200 K}\n";
    if (n % 3 != 1) y += "sun: {azimuth: " + number(within(0, 360)) + " deg, elevation: " + number(within(3, 90)) + " deg, temperature: 5772 K}\n";
    if (n % 3 != 0) {
      y += "lights:\n";
      for (int l = 0; l < 1 + n % 6; ++l)
        y +=
            "  - {name: l" + std::to_string(l) + ", visible: false, intensity: " + number(within(10, 100)) + " W/(sr um), position: " + place(8, 2, 12) + "}\n";
    }
    const std::string plain = ", material: m, temperature: 200 K, ";
    y += "entities:\n";
    y += n % 4 == 3 ? "  - {name: ground, shape: {model: terrain, size: 40 m, relief: 6 m, columns: 60, terrain_seed: " + std::to_string(n) + "}" + plain +
                          "position: [0 m, 0 m, -3 m]}\n"
                    : "  - {name: ground, shape: {model: plate, width: 40 m, height: 40 m}" + plain + "pitch: 90 deg}\n";
    for (int b = 0; b < 5; ++b) {
      static const char* const shapes[] = {"{model: sphere, radius: 1 m}", "{model: box, length: 2 m, width: 1 m, height: 1.5 m}",
                                           "{model: cylinder, radius: 0.6 m, length: 2 m, capped: false}", "{model: jet}", "{model: disc, radius: 1 m}"};
      y += "  - {name: b" + std::to_string(b) + ", shape: " + shapes[(n + b) % 5] + plain + "position: " + place(5, 1, 5) +
           ", heading: " + number(within(0, 360)) + " deg, pitch: " + number(within(-80, 80)) + " deg, roll: " + number(within(-180, 180)) + " deg}\n";
    }
    y += kFilm + std::string("field_of_view: 40 deg, position: ") + place(15, 8, 20) + ", look_at: [0 m, 0 m, 1 m]}\n";
    const Simulation sim = scene(y);
    all += tally(sim, 2);
    if (n % 7 == 3) byRays += tally(sim, 2, By::RaysAlone);
  }
  EXPECT_GT(all.shaded, all.pixels / 20);
  bound("50 random scenes, share of pixels lit otherwise than by exact shadow rays", static_cast<double>(all.wrong) / static_cast<double>(all.pixels), 5e-4,
        "parts thinner than a map's texel; outlines in single precision; " + std::to_string(all.pixels) + " pixels, " + std::to_string(all.shaded) + " shaded");
  EXPECT_GT(byRays.shaded, byRays.pixels / 20);
  bound("7 of them by rays without maps", static_cast<double>(byRays.wrong) / static_cast<double>(byRays.pixels), 5e-4, "outlines in single precision");
}

// Terrain 50 km wide: hills in front of a low sun, near by and over its whole width.
TEST(ShadowsAgainstDouble, HillsAtLowSun) {
  Tally all;
  for (double elevation : {2.0, 8.0, 20.0})
    for (double height : {800.0, 6000.0})
      all += tally(scene(
          "materials: {m: {components: [{reflection: lambertian, reflectance: 0.6}]}}\n"
          "sun: {azimuth: 250 deg, elevation: " +
          number(elevation) +
          " deg, temperature: 5772 K}\n"
          "entities: [{name: ground, shape: {model: terrain, size: 50 km, relief: 1200 m, columns: 250, terrain_seed: 3}, material: m, temperature: 200 K}]\n" +
          kFilm + "field_of_view: 50 deg, position: [2 km, -12 km, " + number(height) + " m], look_at: [0 m, 0 m, 0 m]}\n"));
  EXPECT_GT(all.shaded, 400);
  bound("hills of 50 km terrain at low sun, share of pixels lit otherwise than by exact shadow rays",
        static_cast<double>(all.wrong) / static_cast<double>(all.pixels), 1e-3,
        "outlines in single precision: 4 mm of place at 25 km; " + std::to_string(all.pixels) + " pixels, " + std::to_string(all.shaded) + " shaded");
}

// Panes that reflect receive shadows, and cast none.
TEST(ShadowsAgainstDouble, PanesInShade) {
  const std::string y =
      "materials:\n  m: {components: [{reflection: lambertian, reflectance: 0.6}]}\n  pane: {transmission: {transmittance: 0.5}, components: [{reflection: "
      "lambertian, reflectance: 0.3}]}\n"
      "sun: {azimuth: 120 deg, elevation: 50 deg, temperature: 5772 K}\nlights: [{name: l, visible: false, intensity: 100 W/(sr um), position: [-3 m, 0 m, 8 "
      "m]}]\n"
      "entities:\n"
      "  - {name: ground, shape: {model: plate, width: 40 m, height: 40 m}, material: m, temperature: 200 K, pitch: 90 deg}\n"
      "  - {name: pane, shape: {model: plate, width: 6 m, height: 6 m}, material: pane, temperature: 200 K, pitch: 80 deg, position: [0 m, 0 m, 2 m]}\n"
      "  - {name: ball, shape: {model: sphere, radius: 1 m}, material: m, temperature: 200 K, position: [0 m, 0 m, 4 m]}\n";
  const Tally t = tally(scene(y + kFilm + "field_of_view: 30 deg, position: [14 m, -14 m, 14 m], look_at: [0 m, 0 m, 1 m]}\n"));
  EXPECT_GT(t.shaded, 200);
  bound("panes in shade, share of pixels lit otherwise than by exact shadow rays", static_cast<double>(t.wrong) / static_cast<double>(t.pixels), 5e-4,
        "outlines in single precision; " + std::to_string(t.pixels) + " pixels, " + std::to_string(t.shaded) + " shaded");
}

// Where few pixels may ask for a shadow there is no map: a ball and its shadow from afar, and from within.
TEST(ShadowDemand, FollowsWhatIsSeen) {
  const Simulation sim = scene(
      "sun: {azimuth: 90 deg, elevation: 0 deg, temperature: 5772 K}\nlights: [{name: l, intensity: 1 W/(sr um), position: [0 m, 0 m, 4 m]}]\nentities: "
      "[{name: b, "
      "shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 300 K}]\n" +
      std::string(kFilm) + "field_of_view: 40 deg, position: [0 m, -100 m, 0 m], look_at: [0 m, 0 m, 0 m]}\n");
  const WorldState state = advance(sim, 0.0);
  View view = cameraView(sim.cameras[0], state, 1);
  const double tangent = 2.0 * std::tan(20.0 * kPi / 180.0) / 64.0;
  const ShadowBox box{glm::dvec3(-1.0), glm::dvec3(1.0)};  // of its mesh: on average over directions 6 m2 wide
  const auto asked = [&](size_t light, double nearest_m) { return shadowedSubpixels(sim, state, view, 0, box, light, nearest_m); };
  const auto expect = [&](const char* what, double found, double range_m, double wider) {
    figure(what, found, 6.0 * wider * wider / std::pow(range_m * tangent, 2.0), 1e-12, "a quarter of the box's surface by range squared");
  };
  expect("subpixels of a box of 2 m at 100 m and of its shadow", asked(1, 0.0), 100.0, 1.0);
  view.position = {-300.0, -100.0, 0.0};
  expect("the same with the shadow 100 m off, the box 316 m", asked(1, 0.0), 100.0, 1.0);
  expect("the same on what begins at 150 m", asked(1, 150.0), 150.0, 1.0);
  view.position = {0.0, -100.0, -8.0};
  expect("the same of a lamp 4 m off, 8 m below", asked(0, 0.0), 100.0, 12.0 / (4.0 - std::sqrt(3.0)));
  view.position = {-300.0, -1.5, 0.0};
  EXPECT_EQ(asked(1, 0.0), 64.0 * 64.0) << "in the shadow, or nearly";
  const Pose turned{{10.0, 0.0, 0.0}, glm::angleAxis(0.5 * kPi, glm::dvec3(0.0, 0.0, 1.0))};
  EXPECT_NEAR(distanceTo({{-1.0, -2.0, -3.0}, {1.0, 2.0, 3.0}}, turned, {15.0, 1.0, 7.0}), 5.0, 1e-12) << "3 m beside it and 4 above";
  EXPECT_EQ(distanceTo({{-1.0, -2.0, -3.0}, {1.0, 2.0, 3.0}}, turned, {11.9, 0.9, 2.0}), 0.0);
}

// Layers are made as maps are asked for: those that are drawn already stay as they are.
TEST(DepthMaps, StayWhereMoreAreMade) {
  needContext();
  constexpr int kSize = 65;
  DepthLayers layers(kSize, 1);
  const auto fill = [&](int layer) {
    layers.bindForDrawing(layer);
    glDepthMask(GL_TRUE);
    const GLfloat depth = 0.125f * static_cast<GLfloat>(layer + 1);
    glClearBufferfv(GL_DEPTH, 0, &depth);
  };
  fill(0);
  for (int count : {2, 3, 5, 7}) {
    const int before = layers.count();
    layers.grow(count);
    ASSERT_EQ(layers.count(), count);
    for (int layer = before; layer < count; ++layer) fill(layer);
    for (int layer = 0; layer < count; ++layer) {
      layers.bindForDrawing(layer);
      std::vector<float> depths(kSize * kSize);
      glPixelStorei(GL_PACK_ALIGNMENT, 4);
      glReadPixels(0, 0, kSize, kSize, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
      for (float d : depths) ASSERT_EQ(d, 0.125f * static_cast<float>(layer + 1)) << layer << " of " << count;
    }
  }
  checkGl("growing depth layers");
}

}  // namespace
}  // namespace pitviper::test
