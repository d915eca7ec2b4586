// The GPU's single precision against the CPU's double precision of the same pixel. This measures rounding (and the tables' angle
// grids), never a wrong formula: for those see tests/physics.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scenarios/commands/commands.hpp"
#include "sim/camera/small_bodies.hpp"
#include "sim/gl/context.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/render/reference/reference_pixel.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string channels(double low, double high) {
  return "channels: [{name: a, response: {band: [" + std::to_string(low) + " um, " + std::to_string(high) + " um]}}]";
}

// 0.4 to 14 um, 200 to 3000 K, 1 m to 100 km, where c2/(lambda T) <= 60 and tau >= 1e-9: below 1e-5.
TEST(FloatAgainstDouble, EmissionLightAndAirOverTheRange) {
  double worst = 0.0;
  int pixels = 0;
  std::mt19937 random(5);
  for (const auto& [low, high] : {std::pair{0.4, 0.7}, {1.0, 2.5}, {3.0, 5.0}, {8.0, 14.0}})
    for (double t : {200.0, 300.0, 800.0, 3000.0})
      for (double range : {1.0, 30.0, 1e3, 3e4, 1e5}) {
        if (14387.77 / (low * t) > 60.0) continue;
        const double depth = std::uniform_real_distribution<>(0.01, 20.0)(random);
        const double size = range * 0.3;
        const std::string r = std::to_string(range), s = std::to_string(size);
        const auto sim = scene("atmosphere: {extinction: " + std::to_string(depth * 1e9 / range) +
                               "e-6 /km, temperature: 280 K}\n"
                               "ambient: {temperature: 250 K}\n"
                               "materials: {m: {components: [{reflection: lambertian, reflectance: 0.35}]}}\n"
                               "lights: [{name: l, intensity: {blackbody: 2500 K, area: 1 m2}, position: [" +
                               std::to_string(0.2 * size) + " m, " + s + " m, " + s +
                               " m]}]\n"
                               "entities: [{name: p, shape: {model: plate, width: " +
                               s + " m, height: " + s + " m}, material: m, temperature: " + std::to_string(t) +
                               " K, heading: 70 deg, pitch: 20 deg}]\n"
                               "cameras: [{name: c, film: {width: 24, height: 24}, field_of_view: 20 deg, aperture: 5 mm, position: [" +
                               r + " m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], near: " + std::to_string(0.01 * range) + " m, " + channels(low, high) + "}]\n");
        const Worst w = compare(sim, 5);
        worst = std::max(worst, w.error);
        pixels += static_cast<int>(w.covered);
      }
  EXPECT_GT(pixels, 1000);
  bound("GPU float against CPU double, 0.4-14 um, 200-3000 K, 1 m-100 km", worst, 1e-5, "c2/(lambda T) <= 60, tau >= 2e-9");
}

// Temperature from a texture: Planck's law itself in single precision, where c2/(lambda T) <= 60.
TEST(FloatAgainstDouble, PlanckInTheShader) {
  double worst = 0.0;
  for (const auto& [low, high, coldest] : {std::tuple{0.5, 0.7, 500.0}, {3.0, 5.0, 200.0}, {8.0, 14.0, 200.0}})
    for (double t : {coldest, 1.7 * coldest, 3000.0}) {
      const std::string k = std::to_string(t);
      const auto sim = scene(
          "entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: flat_black_paint, temperature: {rows: [[" + k + " K, " +
          std::to_string(t * 1.05) + " K], [" + std::to_string(t * 1.1) + " K, " + k +
          " K]]}}]\n"
          "cameras: [{name: c, film: {width: 16, height: 16}, field_of_view: 10 deg, aperture: 5 mm, position: [9 m, 1 m, 0 m], look_at: [0 m, 0 m, 0 m], " +
          channels(low, high) + "}]\n");
      worst = std::max(worst, compare(sim, 3).error);
    }
  // Interpolating T in single precision is worth dL/L = c2/(lambda T) dT/T: 60 x 1e-7 at the edge.
  bound("GPU Planck of a temperature texture against CPU double", worst, 2e-5, "c2/(lambda T) <= 60; includes the texture's interpolation, 60 x 1e-7");
}

// Angular tables, modifiers, several components: the tables' angle grids are part of the error.
TEST(FloatAgainstDouble, GeneralMaterials) {
  const auto sim = scene(
      "sun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}\nambient: {temperature: 270 K}\n"
      "atmosphere: {extinction: 0.3 /km, temperature: 285 K, top: 4 km}\n"
      "materials:\n"
      "  gloss: {components: [{reflection: lambertian, reflectance: 0.3, modifier: {rows: [[0.2, 1], [1, 0.6]]}}, {reflection: phong, reflectance: 0.3, "
      "exponent: 25}]}\n"
      "  table: {components: [{reflection: table, wavelength: [3 um, 5 um], angles: [{angle: incidence, count: 3, last: 90 deg}, {angle: specular, count: 4, "
      "last: 180 deg}],"
      " values: [[[0.20, 0.22], [0.18, 0.2], [0.1, 0.12]], [[0.10, 0.12], [0.1, 0.11], [0.09, 0.1]], [[0.08, 0.09], [0.07, 0.08], [0.06, 0.07]], [[0.05, "
      "0.05], [0.05, 0.05], [0.05, 0.05]]]}]}\n"
      "  film: {emission: {emissivity: 0.7, angular: [[0 deg, 1], [60 deg, 0.95], [90 deg, 0.3]], modifier: {rows: [[1, 0.5]]}}, components: [{reflection: "
      "lambertian, reflectance: 0.2}]}\n"
      "lights: [{name: l, intensity: 40 W/(sr um), position: [3 m, 2 m, 4 m]}]\n"
      "entities:\n"
      "  - {name: a, shape: {model: sphere, radius: 1 m}, material: gloss, temperature: 310 K, position: [0 m, -2 m, 0 m]}\n"
      "  - {name: b, shape: {model: sphere, radius: 1 m}, material: table, temperature: 290 K}\n"
      "  - {name: c, shape: {model: cylinder, radius: 1 m, length: 2 m}, material: film, temperature: {rows: [[300 K, 340 K]]}, position: [0 m, 2.2 m, 0 m], "
      "heading: 30 deg}\n"
      "cameras: [{name: c, film: {width: 60, height: 30}, field_of_view: 30 deg, aperture: 5 mm, position: [12 m, 0 m, 1 m], look_at: [0 m, 0 m, 0 m], " +
      channels(3.2, 4.8) + "}]\n");
  const Worst w = compare(sim, 2);
  EXPECT_GT(w.covered, 300);
  bound("GPU general materials against CPU double", w.error, 1e-4, "hemispherical reflectance on a grid of 0.5 deg, linear between");
}

// Near and far in one frame: 0.1 m to 2000 km, the nearer always hides the farther.
TEST(FloatAgainstDouble, DepthHoldsFromATenthOfAMetreToTwoThousandKilometres) {
  std::string entities = "entities:\n";
  const double ranges[] = {0.12, 1.0, 1.001, 50.0, 50.01, 4000.0, 4000.5, 1e5, 1.0001e5, 2e6, 2.0002e6};
  int i = 0;
  for (double r : ranges) {  // each plate beside the axis hides the one behind it over its own strip
    const double size = 0.2 * r;
    entities += "  - {name: p" + std::to_string(i) + ", shape: {model: plate, width: " + std::to_string(size) + " m, height: " + std::to_string(size) +
                " m}, material: blackbody, temperature: " + std::to_string(250 + 10 * i) + " K, position: [" + std::to_string(-r) + " m, 0 m, " +
                std::to_string(size * 0.04 * i) + " m]}\n";
    ++i;
  }
  const auto sim = scene(
      entities + "cameras: [{name: c, film: {width: 64, height: 64}, field_of_view: 16 deg, aperture: 5 mm, position: [0 m, 0 m, 0 m], heading: 270 deg, " +
      channels(8, 12) + "}]\n");
  const Worst w = compare(sim, 3);
  EXPECT_GT(w.covered, 400) << "of 484: pixels on an edge may fall either way";
  bound("0.12 m to 2000 km in one frame, worst error", w.error, 1e-5, "reversed floating-point depth");
}

TEST(Shaders, CompilerMessagesNameTheFile) {
  needContext();
  static const ShaderText broken[] = {{"test/a.glsl", "//@use test/b.glsl\nout vec4 c;\nvoid main() { c = vec4(f()); }\n"},
                                      {"test/b.glsl", "// fine\nfloat f() { return undefinedName; }\n"}};
  ShaderLibrary library;
  library.add(broken);
  const auto fragment = assembleShader(library, "test/a.glsl", {});
  try {
    Program(assembleShader(shaderLibrary(), "sim/render/geometry/glsl/full_screen.vert.glsl", {}), fragment).use();
    FAIL() << "it compiled";
  } catch (const GlError& e) {
    EXPECT_NE(std::string(e.what()).find("test/b.glsl:2"), std::string::npos) << e.what();
  }
}

// The shared bodies, argument by argument: float on the GPU against double, through a program of their own.
TEST(SharedBodies, PlanckAndExponentials) {
  needContext();
  static const ShaderText text[] = {
      {"test/bodies.glsl",
       "//@use sim/radiometry/glsl/planck.glsl\nuniform float base;\nuniform float ratio;\nlayout(location = 0) out vec4 c;\n"
       "void main() { float x = base * pow(ratio, gl_FragCoord.x - 0.5); float t = 2.0 + 12.0 * (gl_FragCoord.y - 0.5) * (gl_FragCoord.y - 0.5);\n"
       "c = vec4(x, oneMinusExp(x), decay(x), planckRadiance(0.3 + 0.1 * (gl_FragCoord.x - 0.5), t)); }\n"}};
  ShaderLibrary library = shaderLibrary();
  library.add(text);
  Program program(assembleShader(library, "sim/render/geometry/glsl/full_screen.vert.glsl", {}), assembleShader(library, "test/bodies.glsl", {}));
  const int width = 300, height = 22;
  RenderTarget target(width, height, {PixelFormat::Rgba32f}, false);
  drawFullScreen(target, program, {{"base", 1e-12f}, {"ratio", 1.15f}});
  Readback readback;
  readback.start(target, 1);
  const auto pixels = readback.wait();
  double expm1 = 0.0, decay = 0.0, planck = 0.0, faint = 0.0;
  int zeros = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float* p = &pixels.colours[0][static_cast<size_t>(4 * (y * width + x))];
      const double v = static_cast<double>(p[0]);
      expm1 = std::max(expm1, std::abs(static_cast<double>(p[1]) / physics::oneMinusExp(v) - 1.0));
      if (v < 87.0) decay = std::max(decay, std::abs(static_cast<double>(p[2]) / physics::decay(v) - 1.0));
      if (v > 88.0) {
        EXPECT_EQ(p[2], 0.0f);
      }
      const float wavelength = 0.3f + 0.1f * static_cast<float>(x), t = 2.0f + 12.0f * static_cast<float>(y) * static_cast<float>(y);
      const double want = physics::planckRadiance(static_cast<double>(wavelength), static_cast<double>(t)), got = static_cast<double>(p[3]);
      ASSERT_TRUE(std::isfinite(got));
      if (got == 0.0) {
        ++zeros;
        EXPECT_GT(14387.77 / static_cast<double>(wavelength * t), 80.0);
      } else {
        const double error = std::abs(got / want - 1.0);
        (14387.77 / static_cast<double>(wavelength * t) <= 60.0 ? planck : faint) =
            std::max(14387.77 / static_cast<double>(wavelength * t) <= 60.0 ? planck : faint, error);
      }
    }
  EXPECT_GT(zeros, 10);
  bound("GPU 1 - exp(-x), x from 1e-12 to 1e6, worst error", expm1, 1e-6, "series below 0.125, 3 bits lost above");
  bound("GPU exp(-x) to x = 87, worst error", decay, 1e-6, "two-part reduction");
  bound("GPU Planck, 0.3-30 um, 2-5300 K, c2/(lambda T) <= 60", planck, 1e-5, "x itself rounds: 60 x 1.5e-7");
  bound("GPU Planck beyond c2/(lambda T) = 60, where not 0", faint, 1e-3, "as promised");
}

// A lamp a hand's breadth above a plate of 200 km, seen from half a kilometre and nearly along it: where the line meets the plate has the digits of the place,
// not of the plate's corners. (By the triangle's weights it was off by centimetres, 5 % of the light.)
TEST(FloatAgainstDouble, LampJustAboveAPlateOfAHundredKilometres) {
  const auto sim = scene(
      "entities: [{name: ground, shape: {model: plate, width: 200 km, height: 200 km}, pitch: 90 deg, material: white_lambertian, temperature: 200 K}]\n"
      "lights: [{name: l, intensity: {blackbody: 2500 K, area: 1e-6 m2}, radius: 1 mm, position: [0.05 m, 523 m, 0.2 m], visible: false}]\n"
      "cameras: [{name: c, film: {width: 24, height: 24}, field_of_view: 0.06 deg, aperture: 5 mm, near: 0.1 m, position: [0 m, 0 m, 3.7 m], look_at: [0 "
      "m, 523 m, 0 m], " +
      channels(1.4, 1.6) + "}]\n");
  const Worst w = compare(sim, 1);
  EXPECT_GT(w.covered, 200);
  bound("lamp 0.2 m above a plate of 200 km, 523 m away, GPU against double", w.error, 2e-3, "523 m have digits of 3e-5 m, the lamp is 0.2 m off");
}

}  // namespace
}  // namespace pitviper::test
