// Air from tables on the GPU against the reference pixel in double precision: surfaces, lights, sun, panes and media, from metres to 300 km.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "sim/radiometry/physics.hpp"
#include "tests/support/air_text.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string writeTable() {
  const auto file = std::filesystem::temp_directory_path() / ("pitviper_gpu_air_" + std::to_string(getpid()) + ".csv");
  const auto depth = [](double um, double km) { return (0.4 + 0.3 * std::cos(5.0 * um)) * std::pow(km, 0.55) + 0.1 * std::pow(km, 0.75) + 0.01 * km; };
  std::ofstream(file) << airCsvText(
      3.0, 5.0, 0.02, std::vector{0.2, 1.0, 3.0, 10.0, 40.0}, [&](double um, double km) { return std::exp(-depth(um, km)); },
      [&](double um, double km) { return -physics::planckRadiance(um, 280.0) * std::expm1(-depth(um, km)); });
  return file.string();
}

TEST(AirFromTables, GpuAgainstDouble) {
  const std::string table = writeTable();
  double worst = 0.0;
  for (const char* mode : {"direct", "buffered"})
    for (const bool transparent : {false, true}) {
      if (transparent && std::string(mode) == "direct") continue;
      std::string yaml = "atmosphere: {csv: " + table + "}\nrender: {mode: " + mode +
                         "}\nsun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}\n"
                         "materials: {m: {components: [{reflection: lambertian, reflectance: 0.35}]}, pane: {transmission: {transmittance: 0.6}}}\n"
                         "lights: [{name: l, intensity: {blackbody: 2500 K, area: 1 m2}, position: [0 m, 5 km, 800 m], visible: false}]\n"
                         "entities:\n  - {name: ground, shape: {model: plate, width: 80 km, height: 80 km}, material: m, temperature: 290 K, pitch: 90 deg}\n"
                         "  - {name: near, shape: {model: sphere, radius: 10 m}, material: m, temperature: 320 K, position: [0 m, 150 m, 300 m]}\n"
                         "  - {name: far, shape: {model: sphere, radius: 900 m}, material: m, temperature: 270 K, position: [2 km, 25 km, 4 km]}\n"
                         "  - {name: farther, shape: {model: sphere, radius: 20 km}, material: m, temperature: 400 K, position: [-40 km, 300 km, 60 km]}\n";
      if (transparent)
        yaml +=
            "  - {name: glass, shape: {model: plate, width: 2 km, height: 2 km}, material: pane, temperature: 310 K, position: [-2 km, 9 km, 1 km]}\n"
            "  - {name: smoke, shape: {model: sphere, radius: 2 km}, material: {absorption: 0.3 /km}, temperature: 290 K, position: [3 km, 18 km, 5 km]}\n"
            "  - {name: plume, shape: {model: sphere, radius: 3 m}, material: {absorption: 0.05 /m}, temperature: 900 K, position: [10 m, 150 m, 310 m]}\n";
      yaml +=
          "cameras: [{name: c, film: {width: 48, height: 48}, field_of_view: 40 deg, aperture: 5 mm, position: [0 m, 0 m, 300 m], look_at: [0 m, 10 km, 1 km], "
          "channels: [{name: a, response: {band: [3.6 um, 4.9 um]}}, {name: b, response: {band: [3.1 um, 4 um]}}]}]\n";
      const Worst w = compare(scene(yaml), 2);
      EXPECT_GT(w.covered, 450);
      worst = std::max(worst, w.error);
    }
  std::filesystem::remove(table);
  bound("air from tables on the GPU against double, 0.1 to 300 km, worst pixel", worst, 1e-5,
        "powers by exp(a ln R) in single precision: 1e-7 of depths to 10 that still let something through, ranges and angles");
}

// The planner's groups of the table's wavelengths, sky included, against the reference's every one.
TEST(AirFromTables, PlannedAgainstReference) {
  const std::string table = writeTable();
  const std::string rest =
      "atmosphere: {csv: " + table +
      "}\nsun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}\n"
      "materials: {m: {components: [{reflection: lambertian, reflectance: 0.35}]}}\n"
      "entities:\n  - {name: ground, shape: {model: plate, width: 80 km, height: 80 km}, material: m, temperature: 290 K, pitch: 90 deg}\n"
      "  - {name: near, shape: {model: sphere, radius: 10 m}, material: m, temperature: 320 K, position: [0 m, 150 m, 300 m]}\n"
      "  - {name: far, shape: {model: sphere, radius: 900 m}, material: m, temperature: 500 K, position: [2 km, 25 km, 4 km]}\n"
      "cameras: [{name: c, film: {width: 32, height: 32}, field_of_view: 40 deg, aperture: 5 mm, position: [0 m, 0 m, 300 m], look_at: [0 m, 10 km, 1 km], "
      "channels: [{name: a, response: {band: [3.1 um, 4.9 um]}}]}]\n";
  const Frame planned = renderFrame(scene("accuracy: 1 %\n" + rest)), reference = renderFrame(scene("accuracy: reference\n" + rest));
  std::filesystem::remove(table);
  double worst = 0.0;
  int compared = 0;
  for (int y = 1; y + 1 < reference.height; ++y)
    for (int x = 1; x + 1 < reference.width; ++x) {
      const double want = at(reference.layers[0], reference, x, y), error = std::abs(at(planned.layers[0], planned, x, y) / want - 1.0);
      // A silhouette may fall either way: a step to a neighbour of more than 2 %.
      bool edge = false;
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
        edge |= std::abs(at(reference.layers[0], reference, x + dx, y + dy) / want - 1.0) > 0.02;
      if (edge) continue;
      ++compared;
      worst = std::max(worst, error);
    }
  EXPECT_GT(compared, 500);
  bound("air from tables planned for 1 %, against every wavelength, worst pixel", worst, 1e-2, "the accuracy asked for");
}

}  // namespace
}  // namespace pitviper::test
