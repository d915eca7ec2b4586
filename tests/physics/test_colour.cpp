// Colours of the ColorChecker as an eye camera sees them, against sums of the published tables; screens' colours against their standard.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "sim/image/srgb.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

const std::filesystem::path kData = std::filesystem::path(PITVIPER_SOURCE_DIR) / "../shared/data/light_colour";

/// Columns of a CSV file by name; empty cells are 0.
std::map<std::string, std::vector<double>> columnsOf(const char* name) {
  std::ifstream file(kData / name);
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> all;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream in(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    if (names.empty()) {
      names = cells;
      continue;
    }
    for (size_t k = 0; k < names.size(); ++k) all[names[k]].push_back(k < cells.size() ? std::atof(cells[k].c_str()) : 0.0);
  }
  return all;
}

double linear(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (at <= x.front()) return at < x.front() - 1e-9 ? 0.0 : y.front();
  if (at >= x.back()) return at > x.back() + 1e-9 ? 0.0 : y.back();
  const size_t i = static_cast<size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin()) - 1;
  return y[i] + (at - x[i]) / (x[i + 1] - x[i]) * (y[i + 1] - y[i]);
}

TEST(Colour, ColorCheckerUnderThreeLights) {
  if (!std::filesystem::is_directory(kData)) GTEST_SKIP() << "no reference tables of lights and colours";
  auto patches = columnsOf("colorchecker_ohta_5nm.csv"), lights = columnsOf("cie_illuminants_5nm.csv"), observer = columnsOf("cie_cmf_1931_2deg_1nm.csv");
  const std::vector<double> at = patches["wavelength_nm"];
  patches.erase("wavelength_nm");
  ASSERT_EQ(patches.size(), 24u);
  std::string materials = "materials:\n", entities = "entities:\n";
  int number = 0;
  std::vector<std::string> names;
  for (const auto& [name, values] : patches) {
    materials +=
        "  m" + std::to_string(number) + ": {components: [{reflection: lambertian, reflectance: {wavelength: um, unit: \"1\", outside: hold, values: [";
    // The patches' wavelengths are those of air.
    for (size_t k = 0; k < at.size(); ++k) materials += print("%s[%.6f, %.9g]", k ? ", " : "", 1e-3 * at[k] * 1.000277, values[k]);
    materials += "]}}]}\n";
    entities += print("  - {name: p%d, shape: {model: plate, width: 1 m, height: 1 m}, material: m%d, temperature: 0 K, position: [0 m, %d m, %d m]}\n", number,
                      number, number % 6, number / 6);
    names.push_back(name);
    ++number;
  }
  struct Light {
    const char *name, *spectrum, *column;
  };
  for (const Light& light : {Light{"D65", "cie_d65", "D65"}, Light{"A", "cie_a", "A"}, Light{"low-pressure sodium", "sodium_low_pressure", ""}}) {
    const Frame f = renderFrame(
        scene("accuracy: reference\nrender: {shadows: false}\n" + materials +
              "sun: {azimuth: 90 deg, elevation: 0 deg, irradiance: {product: [\"3.14159265358979 W/(m2 um)\", " + light.spectrum + "]}}\n" + entities +
              "cameras: [{name: c, film: {width: 60, height: 40}, field_of_view: 3.4336 deg, aperture: 20 mm, position: [100 m, 2.5 m, 1.5 m], "
              "look_at: [0 m, 2.5 m, 1.5 m], eye: true}]\n"));
    double worst = 0.0;
    for (int k = 0; k < number; ++k) {
      const auto& rho = patches[names[static_cast<size_t>(k)]];
      double xyz[3] = {};
      const auto add = [&](double nm, double e) {
        int c = 0;
        for (const char* bar : {"xbar", "ybar", "zbar"})
          xyz[c++] += 683.0 * 1e-3 * e * linear(observer["wavelength_nm"], observer[bar], nm) * linear(at, rho, nm);
      };
      if (*light.column)
        for (int nm = 360; nm <= 780; ++nm) add(nm, linear(lights["wavelength_nm"], lights[light.column], nm) / 100.0);
      else add(588.995, 2e3 / 3.0), add(589.592, 1e3 / 3.0);  // 1 um of the relative spectrum, in nm
      const int column = 5 + 10 * (k % 6), row = 35 - 10 * (k / 6);
      int c = 0;
      for (const char* name : {"X.tristimulus", "Y.tristimulus", "Z.tristimulus"}) {
        const double got = pitviper::test::at(layer(f, name), f, column, row), want = xyz[c++];
        worst = std::max(worst, std::abs(got - want) / std::max({xyz[0], xyz[1], xyz[2]}));
      }
    }
    bound(std::string("tristimulus values of 24 ColorChecker patches under ") + light.name + ", off, of the largest of the three", worst, 2e-3,
          "tables every 5 and 10 nm; a patch ends at 380 nm in one and is held in the other");
  }
}

TEST(Colour, ScreensWhiteAndPrimaries) {
  const glm::dvec3 white = linearSrgb({0.9505, 1.0, 1.0891});
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(white[k], 1.0, 1e-3);
  const Rgb8 red = srgbPixel(linearSrgb({0.4124, 0.2126, 0.0193})), grey = srgbPixel({0.2140, 0.2140, 0.2140});
  EXPECT_EQ(red.r, 255);
  EXPECT_LE(red.g, 2);
  EXPECT_LE(red.b, 2);
  EXPECT_NEAR(grey.g, 127, 1);  // half of a screen's code is a fifth of its light
}

}  // namespace
}  // namespace pitviper::test
