// Truth layers of bodies of a few pixels are those of the same bodies drawn as they fall on pixels: of each pixel's middle.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Worst difference of what both cameras tell where the middle of a pixel sees a body, by layer, and how many pixels that are.
struct Compared {
  double worst = 0.0, ofNeighbours = 0.0;
  int pixels = 0, others = 0, neighbours = 0;
  std::string where;
};

/// A rasteriser counts in 1/256 of a pixel: on an edge between facets it may see the neighbour of what a line through the middle meets, whose normal is
/// another.
constexpr double kSame = 2e-5;

Compared compared(const std::string& world, const std::string& camera) {
  const std::string truth = "truth: [range, entity, normal, temperature, area, solid_angles], channels: [{name: mw, response: {band: [4 um, 5 um]}}]}]\n";
  const Frame small = renderFrame(scene(world + "cameras: [{name: c, " + camera + truth)),
              plain = renderFrame(scene(world + "cameras: [{name: c, small_bodies: 0, " + camera + truth));
  Compared all;
  int layers = 0;
  const auto& entity = layer(plain, "truth.entity").pixels;
  const auto& told = layer(small, "truth.entity").pixels;
  for (std::size_t p = 0; p < entity.size(); ++p) all.pixels += entity[p] > 0.0f, all.others += entity[p] == 0.0f && told[p] > 0.0f;
  for (const FrameLayer& l : plain.layers) {
    if (!l.name.starts_with("truth.")) continue;
    ++layers;
    const auto& other = layer(small, l.name).pixels;
    double scale = 0.0;
    for (std::size_t p = 0; p < entity.size(); ++p)
      if (entity[p] > 0.0f) scale = std::max(scale, std::abs(static_cast<double>(l.pixels[p])));
    for (std::size_t p = 0; p < entity.size(); ++p) {
      if (!(entity[p] > 0.0f) || scale == 0.0) continue;
      const double off = std::abs(static_cast<double>(other[p]) - static_cast<double>(l.pixels[p])) / scale;
      if (off > kSame && l.name != "truth.range" && l.name != "truth.entity") ++all.neighbours, all.ofNeighbours = std::max(all.ofNeighbours, off);
      else if (off > all.worst)
        all.worst = off,
        all.where = l.name + print(" pixel %g: %g for %g", static_cast<double>(p), static_cast<double>(other[p]), static_cast<double>(l.pixels[p]));
    }
  }
  EXPECT_GE(layers, 9);
  return all;
}

const std::string kLamp =
    "accuracy: none\nbackground: {temperature: 0 K}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.3}]}, gas: {absorption: 0.05 /m}, "
    "pane: {components: [], transmission: "
    "{transmittance: 0.6}}}\nlights: [{name: lamp, visible: false, intensity: {wavelength: um, unit: W/(sr um), values: [[3, 100], [6, 100]]}, position: [60 "
    "m, 20 m, 10 m]}]\n";
const std::string kEye =
    "film: {width: 8, height: 8, pitch: 20 um}, focal_length: 2 mm, aperture: 1 mm, position: [100 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], ";

// A plate whose range changes by 1.7 m a pixel, and one whose temperature does: of the pixels' middles by hand.
TEST(SmallBodyTruth, IsThatOfThePixelsMiddle) {
  const std::string eye = "film: {width: 6, height: 6, pitch: 20 um}, focal_length: 2 mm, aperture: 1 mm, position: [100 m, 0 m, 0 m], look_at: p, ";
  const Frame f =
      renderFrame(scene("accuracy: none\nbackground: {temperature: 0 K}\nentities: [{name: p, shape: {model: plate, width: 8 m, height: 4 m}, material: "
                        "blackbody, temperature: 300 K, heading: 150 "
                        "deg}]\ncameras: [{name: c, " +
                        eye + "truth: [range], channels: [{name: mw, response: {band: [4 um, 5 um]}}]}]\n"));
  // Lines (1, u, v) of tangents u, v = +- 0.005 meet the plane x = -y tan(60 deg) seen from x = 100: range (1 + u^2 + v^2)^(1/2) 100 / (1 -+ u tan 60 deg).
  const double tilt = std::tan(60.0 * kPi / 180.0);
  for (int column : {2, 3})
    for (int row : {2, 3}) {
      const double u = (column + 0.5 - 3.0) * 0.01, v = 0.005, flat = std::sqrt(1.0 + u * u + v * v) * 100.0;
      const double told = at(layer(f, "truth.range"), f, column, row), near = flat / (1.0 + std::abs(u) * tilt), far = flat / (1.0 - std::abs(u) * tilt);
      const double right = std::abs(told - near) < std::abs(told - far) ? near : far;
      figure(print("range of a turned plate, column %g", static_cast<double>(column)), told, right, 1e-5, "a plane met by a line; single precision");
    }
}

TEST(SmallBodyTruth, IsThatOfBodiesDrawnWhole) {
  std::mt19937 dice(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const char* shapes[] = {"{model: plate, width: 6 m, height: 3 m}", "{model: jet}", "{model: cylinder, radius: 0.8 m, length: 5 m}",
                          "{model: box, length: 4 m, width: 2 m, height: 1 m}", "{model: sphere, radius: 2 m}"};
  double worst = 0.0, ofNeighbours = 0.0;
  int pixels = 0, neighbours = 0;
  std::string where;
  for (int k = 0; k < 15; ++k) {
    std::string world = kLamp + "entities:\n";
    for (int b = 0; b < 1 + k % 3; ++b)
      world += "- {name: b" + std::to_string(b) + ", shape: " + shapes[(k + b) % 5] + ", material: m, temperature: " +
               (k % 2 ? std::string("{rows: [[300 K, 320 K, 340 K], [400 K, 450 K, 500 K]]}") : std::to_string(300 + 40 * b) + " K") +
               print(", position: [%.3f m, %.3f m, ", 6.0 * unit(dice) - 3.0, 4.0 * unit(dice) - 2.0) +
               print("%.3f m], heading: %.2f deg, ", 4.0 * unit(dice) - 2.0, 360.0 * unit(dice)) + print("pitch: %.2f deg}\n", 120.0 * unit(dice) - 60.0);
    if (k % 5 == 3) world += "- {name: smoke, shape: {model: sphere, radius: 1.5 m}, material: gas, temperature: 350 K, position: [5 m, 0.3 m, 0 m]}\n";
    if (k % 5 == 4)
      world += "- {name: window, shape: {model: plate, width: 3 m, height: 3 m}, material: pane, temperature: 290 K, position: [8 m, 0.3 m, 0 m]}\n";
    for (const char* samples : {"samples: 1, ", "samples: 2, ", "samples: 3, "}) {
      const Compared c = compared(world, kEye + samples);
      pixels += c.pixels;
      neighbours += c.neighbours;
      ofNeighbours = std::max(ofNeighbours, c.ofNeighbours);
      if (c.worst > worst) worst = c.worst, where = print("%g ", static_cast<double>(k)) + samples + c.where;
    }
  }
  EXPECT_GT(pixels, 300);
  bound("truth layers of small bodies against the same drawn whole: " + where, worst, kSame, "double against single precision of the same places");
  bound("pixels whose middle lies on an edge between facets, share", static_cast<double>(neighbours) / (9.0 * pixels), 0.01,
        "some pixels' lengths of edges, 1/256 wide");
  bound("normals there", ofNeighbours, 0.05, "from one facet of a body of some pixels to the next");
}

// In every mode.
TEST(SmallBodyTruth, InEveryMode) {
  const std::string bodies =
      "entities:\n- {name: a, shape: {model: plate, width: 6 m, height: 3 m}, material: m, temperature: 320 K, position: [0 m, 0.3 m, 0.2 m], heading: 140 "
      "deg}\n"
      "- {name: b, shape: {model: jet}, material: m, temperature: 300 K, position: [-6 m, -2 m, 1 m], heading: 30 deg}\n";
  for (const char* mode : {"render: {mode: buffered}\n", "render: {mode: direct}\n", "accuracy: reference\n", "accuracy: 1 %\n"}) {
    std::string world = kLamp + bodies + mode;
    if (std::string(mode).starts_with("accuracy")) world = world.substr(world.find('\n') + 1);
    const Compared c = compared(world, kEye);
    EXPECT_GT(c.pixels, 10) << mode;
    bound(std::string("truth of two small bodies, ") + mode, c.worst, kSame, "single precision; " + c.where);
  }
}

}  // namespace
}  // namespace pitviper::test
