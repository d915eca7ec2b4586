// Light of narrow lines, and bands from the ultraviolet to 999 um, through the renderer in every mode.
#include <gtest/gtest.h>

#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

const char* kModes[][2] = {{"accuracy: 1 %\n", "1 %"},
                           {"accuracy: 0.1 %\n", "0.1 %"},
                           {"accuracy: reference\n", "reference"},
                           {"", "16 Gauss points"},
                           {"render: {mode: buffered}\n", "16 Gauss points, buffered"}};

TEST(NarrowLines, ALampsLineLightsAWall) {
  for (const auto& [mode, name] : kModes) {
    const Simulation sim = scene(
        std::string(mode) +
        "lights: [{name: lamp, visible: false, position: [0 m, 3 m, 0 m], intensity: {wavelength: um, unit: W/(sr um), outside: zero, "
        "values: [[0.5, 0], [0.5885, 0], [0.589, 2000], [0.5895, 0], [0.6, 0]]}}]\n"
        "materials: {w: {components: [{reflection: lambertian, reflectance: 1.0}]}}\n"
        "entities: [{name: wall, shape: {model: plate, width: 6 m, height: 6 m}, material: w, position: [0 m, 8 m, 0 m], heading: 180 deg, temperature: 0 K}]\n"
        "cameras: [{name: c, film: {width: 3, height: 3}, field_of_view: 0.1 deg, aperture: 50 mm, position: [0 m, -10 m, 0 m], look_at: wall, "
        "channels: [{name: v, response: {band: [0.45 um, 0.75 um]}}]}]\n");
    figure(std::string("wall 5 m from a lamp of one line 1 nm wide, ") + name, static_cast<double>(renderFrame(sim).layers[0].pixels[4]), 1.0 / (25.0 * kPi),
           1e-5, "1 W/sr over pi d2");
  }
}

TEST(NarrowLines, BandsOfManyOctaves) {
  for (double high : {14.0, 100.0, 999.0})
    for (const char* accuracy : {"1 %", "reference"}) {
      const Simulation sim =
          scene(std::string("accuracy: ") + accuracy +
                "\nentities: [{name: wall, shape: {model: plate, width: 4 m, height: 4 m}, material: blackbody, heading: 180 deg, temperature: 1000 K}]\n"
                "cameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 50 mm, position: [0 m, -10 m, 0 m], look_at: wall, "
                "channels: [{name: a, response: {band: [0.2 um, " +
                std::to_string(high) + " um]}}]}]\n");
      figure("black plate of 1000 K, 0.2 um to " + std::to_string(static_cast<int>(high)) + " um, " + accuracy,
             static_cast<double>(renderFrame(sim).layers[0].pixels[0]), blackBodyBand(0.2, high, 1000.0), 1e-4, "series of the Planck integral");
    }
}

}  // namespace
}  // namespace pitviper::test
