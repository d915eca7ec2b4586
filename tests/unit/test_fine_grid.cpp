// The reference's grid of wavelengths: narrow lines keep their energy, wide bands their steep flanks, and smooth scenes their number of bins.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/plan/fine_grid.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

double over(const std::vector<QuadratureNode>& grid, const Spectrum& s) {
  double sum = 0.0;
  for (const QuadratureNode& n : grid) sum += n.weight * s(n.x);
  return sum;
}

Simulation lampOf(Spectrum::Table table) {
  Simulation sim;
  table.outside = Outside::Zero;
  PointLight lamp;
  lamp.intensity = Spectrum(std::move(table));
  sim.lights.push_back(std::move(lamp));
  return sim;
}

TEST(FineGrid, LinesKeepTheirEnergy) {
  const Spectrum band = Spectrum::band(0.45, 0.75);
  double worst = 0.0;
  for (double half : {5e-4, 1.7e-4, 1e-5, 1e-7})
    for (double at : {0.589, 0.5000001, 0.6543}) {
      const Simulation sim = lampOf({{0.4, at - half, at, at + half, 0.8}, {0, 0, 1.0 / half, 0, 0}, Outside::Zero, ""});
      const auto grid = fineGrid(band, sim);
      worst = std::max(worst, std::abs(over(grid, sim.lights[0].intensity) - 1.0));
      EXPECT_LE(grid.size(), 304u);
      double whole = 0.0;
      for (const QuadratureNode& n : grid) whole += n.weight;
      EXPECT_NEAR(whole, 0.3, 1e-12);
    }
  bound("lamp lines of half widths 0.5 nm to 1e-7 um on the reference's grid, energy, relative", worst, 1e-6,
        "bins end at their bends; wavelengths round at 1e-16 um");
}

TEST(FineGrid, ManyLinesAndSteps) {
  const Spectrum band = Spectrum::band(0.45, 0.75);
  Spectrum::Table comb;
  comb.outside = Outside::Zero;
  double energy = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double at = 0.45002 + 1.5e-4 * i, strength = 1.0 + (i * 37 % 11);
    comb.wavelength_um.insert(comb.wavelength_um.end(), {at - 1e-5, at, at + 1e-5});
    comb.value.insert(comb.value.end(), {0.0, strength, 0.0});
    energy += 1e-5 * strength;
  }
  const Simulation lines = lampOf(comb);
  figure("2000 lines 0.15 nm apart on the reference's grid", over(fineGrid(band, lines), lines.lights[0].intensity), energy, 1e-9, "sum of triangles");
  const Simulation step = lampOf({{0.4, 0.60037, 0.60037, 0.6009, 0.6009, 0.8}, {0.0, 0.0, 5.0, 5.0, 0.0, 0.0}, Outside::Zero, ""});
  figure("a step 0.5 nm wide on the reference's grid", over(fineGrid(band, step), step.lights[0].intensity), 5.0 * (0.6009 - 0.60037), 1e-9, "width x height");
}

TEST(FineGrid, WideBandsAreEvenWhereLightIs) {
  const Simulation nothing;
  for (double kelvin : {300.0, 1000.0, 3000.0, 6000.0}) {
    const Spectrum black(Spectrum::BlackBody{kelvin, 1.0});
    double worst = 0.0;
    for (const auto& [low, high] : {std::pair{0.2, 14.0}, {0.2, 100.0}, {0.2, 999.0}, {20.0, 999.0}})
      worst = std::max(worst, std::abs(over(fineGrid(Spectrum::band(low, high), nothing), black) / blackBodyBand(low, high, kelvin) - 1.0));
    bound("black body of " + print("%g", kelvin) + " K over 0.2-14 to 20-999 um on the reference's grid, relative", worst, 1e-4, "bins of 5 1/cm, 1 nm, 1 %");
  }
  for (const QuadratureNode& n : fineGrid(Spectrum::band(0.1, 1000.0), nothing)) ASSERT_LE(n.weight, 0.0106 * n.x) << n.x;
}

TEST(FineGrid, SmoothScenesKeepTheirBins) {
  const Spectrum band = Spectrum::band(0.45, 0.75);
  const Simulation smooth = lampOf({{0.4, 0.4995, 0.5763, 0.8}, {1.0, 1.2, 1.0, 1.4}, Outside::Zero, ""});
  EXPECT_EQ(fineGrid(band, smooth).size(), fineGrid(band).size());
  EXPECT_EQ(fineGrid(band).size(), 300u);
  const Simulation sim = scene(
      "atmosphere: clear_us76\nprobes: [{name: p, position: [0 m, 0 m, 1 m], channels: [{name: a, response: {band: [8 um, 12 um]}, output: irradiance}]}]\n");
  for (const auto& [low, high] : {std::pair{3.6, 4.9}, {8.0, 12.0}}) {
    const Spectrum infrared = Spectrum::band(low, high);
    const auto grid = fineGrid(infrared, sim);
    EXPECT_LE(grid.size(), fineGrid(infrared).size() + 4);
    // Within each piece of the air's table: the middle is the mean.
    const BentSpectrum air = airSpectrum(*sim.air);
    double sum = 0.0, whole = integrate(air.at, low, high, air.knots_um);
    for (const QuadratureNode& n : grid) sum += n.weight * air.at(n.x);
    EXPECT_NEAR(sum / whole, 1.0, 1e-4) << low;  // at the band's ends a bin holds a bend
  }
}

TEST(FineGrid, RulesOfFewSamplesHaveNodesOnLines) {
  const Spectrum band = Spectrum::band(0.45, 0.75);
  const Simulation sodium = lampOf({{0.4, 0.5885, 0.589, 0.5895, 0.8}, {0, 0, 2000, 0, 0}, Outside::Zero, ""});
  for (Spacing spacing : {Spacing::Gauss, Spacing::Even, Spacing::Log}) {
    const auto plain = spectralRule(band, 16, spacing);
    EXPECT_NEAR(over(plain, sodium.lights[0].intensity), 0.0, 0.5);
    const auto lines = narrowLines(spectraOf(sodium), band, plain);
    ASSERT_EQ(lines.size(), 1u);
    auto rule = spectralRule(band * betweenLines(lines), 16, spacing);
    const auto own = lineNodes(lines, band);
    EXPECT_EQ(own.size(), 6u);
    rule.insert(rule.end(), own.begin(), own.end());
    EXPECT_NEAR(over(rule, sodium.lights[0].intensity), 1.0, 1e-9);
    EXPECT_NEAR(over(rule, Spectrum(Spectrum::BlackBody{3000.0, 1.0})) / blackBodyBand(0.45, 0.75, 3000.0), 1.0, spacing == Spacing::Gauss ? 1e-9 : 1e-3);
  }
  // Smooth, or rough all over: left to the samples.
  Spectrum::Table rough;
  rough.outside = Outside::Zero;
  for (int i = 0; i <= 400; ++i) rough.wavelength_um.push_back(0.4 + 0.001 * i), rough.value.push_back(1.0 + 0.2 * (i * 7919 % 13));
  for (const auto& sim : {lampOf({{0.4, 0.5, 0.8}, {1, 2, 1}, Outside::Zero, ""}), lampOf(rough)})
    EXPECT_TRUE(narrowLines(spectraOf(sim), band, spectralRule(band, 16, Spacing::Gauss)).empty());
}

}  // namespace
}  // namespace pitviper::test
