// What is left out because it cannot be seen, bodies behind others and lights too weak to tell, against the double precision reference, which
// leaves nothing out.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr const char* kCamera =
    "cameras:\n  - name: c\n    film: {width: 48, height: 40}\n    field_of_view: 40 deg\n    aperture: 5 mm\n    small_bodies: 0\n"
    "    position: [20 m, 0 m, 1 m]\n    look_at: [0 m, 0 m, 0 m]\n    truth: [range, entity, normal, temperature, area, solid_angles]\n"
    "    channels: [{name: mw, response: {band: [3 um, 5 um]}}]\n";

/// A sphere of 1984 triangles: enough for its box to be asked for.
std::string sphere(const std::string& name, double x, double y, double z, double radius, int temperature_K) {
  return "  - {name: " + name + ", shape: {model: sphere, radius: " + std::to_string(radius) +
         " m, segments: 64}, material: sand, temperature: " + std::to_string(temperature_K) + " K, position: [" + std::to_string(x) + " m, " +
         std::to_string(y) + " m, " + std::to_string(z) + " m]}\n";
}

// The farthest first in the file; some wholly hidden, some behind an edge, one around the camera, instances of one small mesh between them.
TEST(HiddenAndDark, DenseBodiesBehindEachOther) {
  std::string y = "ambient: {temperature: 260 K}\nentities:\n";
  y += sphere("far", -30, 0, 0, 4, 290) + sphere("hidden", -12, 0.2, 0, 1, 320) + sphere("edge", -8, 3.2, 1, 1.5, 330) + sphere("low", -5, -2, -2.5, 2, 340);
  for (int i = 0; i < 6; ++i)
    y += "  - {name: box" + std::to_string(i) +
         ", shape: {model: box, length: 1 m, width: 0.6 m, height: 0.4 m}, material: sand, temperature: " + std::to_string(300 + 10 * i) + " K, position: [" +
         std::to_string(6 - 4 * i) + " m, " + std::to_string(i - 2.5) + " m, 2 m], heading: " + std::to_string(20 * i) + " deg}\n";
  y += sphere("front", 0, 0, 0, 2.5, 310) + sphere("around", 20, 0, 1, 200, 280);
  const Worst w = compare(scene(y + kCamera), 1);
  EXPECT_EQ(w.covered, 48 * 40 - w.missed);
  bound("dense and repeated bodies behind each other, pixels that see another body than the reference", w.missed, 20,
        "silhouettes may fall either way, 1 % of 1920 pixels");
  bound("dense and repeated bodies behind each other, GPU float against CPU double", w.error, 1e-5, "single precision");
}

// More lights than have places of their own; from dark, far and behind to strong ones.
TEST(HiddenAndDark, LightsThatCannotMatter) {
  std::string y = "atmosphere: {extinction: 0.4 /km, temperature: 285 K}\nsun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}\nlights:\n";
  const struct { double intensity, x; } lights[] = {{40, 15}, {1e-6, 30}, {1e4, 5e5}, {0, 10}, {300, -40}, {5, 8}, {1e-3, 12}};
  for (size_t i = 0; i < std::size(lights); ++i)
    y += "  - {name: l" + std::to_string(i) + ", intensity: " + std::to_string(lights[i].intensity) + " W/(sr um), visible: false, position: [" +
         std::to_string(lights[i].x) + " m, " + std::to_string(i) + " m, 4 m]}\n";
  y += "entities:\n" + sphere("a", 0, 0, 0, 2.5, 310) +
       "  - {name: b, shape: {model: sphere, radius: 1 m}, material: sand, temperature: 0 K, position: [3 m, 3 m, 1 m]}\n";
  const Worst w = compare(scene(y + kCamera), 1);
  EXPECT_GT(w.covered, 500);
  bound("seven lights and the sun, some that cannot matter, 99 % of pixels", w.percentile99, 1e-5, "single precision");
  bound("seven lights and the sun, some that cannot matter, worst pixel", w.error, 1e-4,
        "cosine of the sun at the terminator; the same with no light left out");
}

// A mirror-like lobe gathers what its reflectance alone would call nothing.
TEST(HiddenAndDark, AWeakLightInANarrowLobe) {
  std::string camera = kCamera;  // an odd film: its middle pixel sees the mirror's direction exactly
  camera.replace(camera.find("width: 48, height: 40"), 21, "width: 49, height: 41");
  const std::string y =
      "materials: {mirror: {components: [{reflection: phong, reflectance: 0.5, exponent: 100000}]}}\n"
      "lights: [{name: l, intensity: 2e-6 W/(sr um), visible: false, position: [20 m, 0 m, -1 m]}]\n"
      "entities:\n  - {name: plate, shape: {model: plate, width: 4 m, height: 4 m}, material: mirror, temperature: 310 K}\n";
  const auto weak = scene(y + camera), dark = scene(std::string(y).replace(y.find("2e-6"), 4, "0") + camera);
  const Frame a = renderFrame(weak), b = renderFrame(dark);
  double most = 0.0;
  for (size_t p = 0; p < a.layers[0].pixels.size(); ++p)
    if (b.layers[0].pixels[p] > 0.0f) most = std::max(most, static_cast<double>(a.layers[0].pixels[p] / b.layers[0].pixels[p]) - 1.0);
  EXPECT_GT(most, 1e-5) << "the light has been left out";
  bound("a weak light in a narrow lobe, GPU float against CPU double", compare(weak, 1).error, 1e-5, "single precision");
}

}  // namespace
}  // namespace pitviper::test
