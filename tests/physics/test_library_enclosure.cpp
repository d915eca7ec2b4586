// The laws that every named surface and every substance keeps: an enclosure of one temperature is flat, reflection is reciprocal, and optical constants are
// those that were measured.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "materials/film_stack.hpp"
#include "materials/refractive_index.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/hemisphere.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

const std::filesystem::path kRoot = PITVIPER_SOURCE_DIR;

/// Named surfaces: library files without a medium.
std::vector<std::string> surfaces() {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(kRoot / "materials/library"))
    if (entry.path().extension() == ".yaml" && !loadYaml(entry.path(), {}).find("absorption")) all.push_back(entry.path().stem().string());
  std::sort(all.begin(), all.end());
  return all;
}

/// A row of spheres, one of each, in an enclosure, where all of them have data.
Simulation enclosureOf(const std::vector<std::string>& names, const std::string& accuracy) {
  std::string entities;
  for (size_t k = 0; k < names.size(); ++k)
    entities += "  - {name: b" + std::to_string(k) + ", shape: {model: sphere, radius: 1 m, segments: 48}, material: " + names[k] +
                print(", temperature: 600 K, position: [0 m, %g m, %g m]}\n", 2.2 * static_cast<double>(k % 8), 2.2 * static_cast<double>(k / 8));
  return scene(
      accuracy + "background: {temperature: 600 K}\nambient: {temperature: 600 K}\nentities:\n" + entities +
      "cameras: [{name: c, film: {width: 136, height: 104}, field_of_view: 11 deg, aperture: 20 mm, position: [100 m, 7.7 m, 5.5 m], look_at: [0 m, 7.7 m, "
      "5.5 m], truth: [entity], channels: [{name: a, response: {band: [1.5 um, 1.8 um]}}, {name: b, response: {band: [3 um, 3.5 um]}}]}]\n");
}

TEST(Library, EnclosuresAreFlat) {
  const auto names = surfaces();
  EXPECT_GE(names.size(), 38u);
  for (const char* accuracy : {"", "accuracy: 1 %\n"}) {
    const Frame f = renderFrame(enclosureOf(names, accuracy));
    std::map<std::string, double> worst;
    const auto& body = layer(f, "truth.entity").pixels;
    for (const auto& [channel, low, high] : {std::tuple{"a.radiance", 1.5, 1.8}, std::tuple{"b.radiance", 3.0, 3.5}})
      for (size_t p = 0; p < body.size(); ++p) {
        const auto own = static_cast<size_t>(std::max(body[p], 0.0f));  // 0: what lies behind all bodies
        double& w = worst[own == 0 ? "panes, and what is behind them" : names.at(own - 1)];
        w = std::max(w, std::abs(static_cast<double>(layer(f, channel).pixels[p]) / blackBodyBand(low, high, 600.0) - 1.0));
      }
    EXPECT_GE(worst.size(), names.size() - 8);  // but for panes
    for (const auto& [name, w] : worst) bound("enclosure, " + name + (*accuracy ? ", planned" : ""), w, 1e-4, "asked for; views from 0 to 89 deg");
  }
}

TEST(Library, ReflectsAlikeBothWays) {
  double worst = 0.0;
  const Simulation sim = enclosureOf(surfaces(), "");
  for (const auto& m : sim.materials)
    for (const auto& r : m->reflections) {
      const auto axes = r->axes();
      const bool byView = axes[0].angle == Angle::View || axes[1].angle == Angle::View,
                 byLight = axes[0].angle == Angle::Incidence || axes[1].angle == Angle::Incidence;
      if (byView && !byLight) continue;  // windows by tables over the view angle: cones about the mirrored direction
      for (int i = 0; i < 300; ++i) {
        const auto [l, v] = directionPair(i);
        const double f = r->brdf(1.6, l, v), g = r->brdf(1.6, v, l);
        worst = std::max(worst, std::abs(f - g) / std::max(1e-6, f + g));
      }
    }
  bound("f(l, v) against f(v, l) over the library, relative", worst, 1e-5, "asked for");
}

RefractiveIndex substance(const std::string& name) {
  const Value file = loadYaml(kRoot / "materials/substances" / (name + ".yaml"), {});
  return readRefractiveIndex(*file.find("index"), [](const Value& v, const Parameter& p) { return Spectrum(readNumber(v, p.unit, p.key)); }, {});
}

// Published values at single wavelengths.
TEST(Substances, HavePublishedIndices) {
  struct Point {
    const char* name;
    double um, n;
    const char* source;
  };
  for (const Point& p :
       {Point{"fused_silica", 0.58756, 1.45846, "Malitson 1965, d line"}, Point{"sapphire", 0.58756, 1.76817, "Malitson and Dodge 1972, d line"},
        Point{"magnesium_fluoride", 0.58756, 1.37774, "Dodge 1984, d line"}})
    figure(std::string(p.name) + print(", n at %g um", p.um), substance(p.name)(p.um).real(), p.n, 5e-5, p.source);
}

// Against tables measured by others, where they are at hand: reflectance at normal view.
TEST(Substances, ReflectAsMeasured) {
  const std::filesystem::path folder = kRoot / "../shared/data/nk";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no reference tables of n and k";
  struct Pair {
    const char *name, *file;
    double low_um, high_um, off;
    const char* why;
  };
  for (const Pair& p :
       {Pair{"aluminium", "Al_Rakic", 0.3, 27.0, 0.02, "two fits by the same author"}, Pair{"gold", "Au_Ordal", 0.7, 25.0, 0.03, "evaporated against bulk"},
        Pair{"copper", "Cu_Ordal", 0.7, 25.0, 0.03, "evaporated against bulk"}, Pair{"titanium", "Ti_Ordal", 0.67, 25.0, 0.003, "thinned"},
        Pair{"tungsten", "W_Ordal", 0.7, 25.0, 0.02, "films against bulk"}, Pair{"nickel", "Ni_Ordal", 0.7, 25.0, 0.02, "evaporated against bulk"},
        Pair{"iron", "Fe_Ordal", 0.67, 28.0, 0.003, "thinned"}, Pair{"fused_silica", "SiO2_Malitson", 0.3, 3.7, 1e-5, "the same formula"},
        Pair{"sapphire", "Al2O3_Malitson", 0.3, 5.0, 1e-3, "1962 against 1972"}, Pair{"water", "H2O_Hale", 0.3, 29.0, 0.002, "thinned"},
        Pair{"titanium_dioxide_film", "TiO2_Siefke", 0.31, 29.0, 0.01, "thinned"},
        Pair{"hematite", "Fe2O3_Querry-o", 0.31, 29.0, 0.016, "thinned to 0.03 of n and k"}}) {
    const RefractiveIndex index = substance(p.name);
    std::ifstream file(folder / (std::string(p.file) + ".csv"));
    double worst = 0.0;
    int rows = 0;
    for (std::string line; std::getline(file, line);) {
      double w, n, k;
      char comma;
      std::istringstream in(line);
      if (!(in >> w >> comma >> n) || w < p.low_um || w > p.high_um) continue;
      k = 0.0;
      in >> comma >> k;
      ++rows;
      worst = std::max(worst, std::abs(filmPower({}, index(w), w, 0.0).reflectance - filmPower({}, {n, k}, w, 0.0).reflectance));
    }
    EXPECT_GT(rows, 10) << p.file;
    bound(std::string(p.name) + ", reflectance at normal view against " + p.file, worst, p.off, p.why);
  }
}

}  // namespace
}  // namespace pitviper::test
