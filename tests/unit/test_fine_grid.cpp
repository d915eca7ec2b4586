// The reference's grid of wavelengths: narrow lines keep their energy, wide bands their steep flanks, and smooth scenes their number of bins.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "materials/reflection.hpp"
#include "sim/plan/fine_grid.hpp"
#include "sim/plan/kernel_family.hpp"
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

/// Triangles of a half width at places, one strength each.
Spectrum::Table lines(double low, double high, double half, const std::vector<double>& at, double strength) {
  Spectrum::Table t;
  t.outside = Outside::Zero;
  t.wavelength_um = {low}, t.value = {0.0};
  for (double w : at) {
    t.wavelength_um.insert(t.wavelength_um.end(), {w - half, w, w + half});
    t.value.insert(t.value.end(), {0.0, strength, 0.0});
  }
  t.wavelength_um.push_back(high), t.value.push_back(0.0);
  return t;
}

const std::vector<double> kPlaces = {3.30117, 3.71941, 4.00277, 4.2509, 4.6803};

TEST(FineGrid, ResponsesOfNarrowPeaks) {
  // Bins of 5 to 12 nm hold peaks of 0.02 to 1 nm: looked at where the peak is.
  const Simulation nothing;
  double worst = 0.0;
  for (double half : {1e-5, 1e-4, 5e-4})
    for (size_t count : {1, 2, 5}) {
      const Spectrum response(lines(3.0, 5.0, half, {kPlaces.begin(), kPlaces.begin() + static_cast<std::ptrdiff_t>(count)}, 1.0));
      for (double kelvin : {250.0, 300.0, 1000.0}) {
        const Spectrum black(Spectrum::BlackBody{kelvin, 1.0});
        const double whole = integrate([&](double w) { return response(w) * black(w); }, 3.0, 5.0, response.knots());
        worst = std::max(worst, std::abs(over(fineGrid(response, nothing), black) / whole - 1.0));
      }
    }
  bound("black bodies through responses of narrow peaks on the reference's grid, relative", worst, 1e-5, "bins are looked at where the response is");
}

TEST(FineGrid, LinesOfAResponseAndOfALampInOneBin) {
  const Spectrum band(lines(0.4, 0.8, 5e-5, {0.50012, 0.6003}, 1.0));
  double worst = 0.0;
  for (double aside : {0.0, 3e-5, 6e-5}) {
    const Simulation sim = lampOf(lines(0.3, 0.9, 4e-5, {0.50012 + aside, 0.6003 - aside}, 1.0));
    auto knots = band.knots();
    for (double k : sim.lights[0].intensity.knots()) knots.push_back(k);
    std::sort(knots.begin(), knots.end());
    const double whole = integrate([&](double w) { return band(w) * sim.lights[0].intensity(w); }, 0.4, 0.8, knots);
    worst = std::max(worst, std::abs(over(fineGrid(band, sim), sim.lights[0].intensity) / whole - 1.0));
  }
  bound("lamp lines of 0.08 nm through peaks of 0.1 nm of a response in the same bin, relative", worst, 1e-6, "bins end at the lamp's bends");
}

TEST(FineGrid, RoughLampsOfThousandsOfRows) {
  // Rows 0.002 nm apart, 500 a bin.
  Spectrum::Table rough;
  rough.outside = Outside::Zero;
  unsigned seed = 1;
  for (int i = 0; i <= 60000; ++i) {
    seed = seed * 1664525u + 1013904223u;
    rough.wavelength_um.push_back(0.5 + 2e-6 * i);
    rough.value.push_back(std::exp(-4.0 * std::log((seed >> 8) * 0x1p-24 + 1e-9)));
  }
  const Simulation sim = lampOf(rough);
  const auto grid = fineGrid(Spectrum::band(0.51, 0.61), sim);
  const double whole = sim.lights[0].intensity.integral(0.51, 0.61);
  bound("a lamp of 50000 random rows, few of them bright, on the reference's grid, relative", std::abs(over(grid, sim.lights[0].intensity) / whole - 1.0), 1e-4,
        "bins are looked at where they are their mean, or their middle is within 0.5 %");
  EXPECT_LE(grid.size(), 100u * 40u);
  // As many rows of a smooth one are no reason for more bins.
  Spectrum::Table smooth = rough;
  for (size_t i = 0; i < smooth.value.size(); ++i) smooth.value[i] = 1.0 + smooth.wavelength_um[i];
  EXPECT_EQ(fineGrid(Spectrum::band(0.51, 0.61), lampOf(smooth)).size(), fineGrid(Spectrum::band(0.51, 0.61)).size());
}

TEST(FineGrid, CurvesOfGrowth) {
  // Lines of a gas far narrower than a bin, through 1 mm to 10 km of it: what they take, and what passes between.
  double worst = 0.0, wide = 0.0;
  for (double half : {1e-6, 1e-4, 1e-3, 0.03}) {
    Simulation sim;
    auto gas = std::make_shared<Material>();
    gas->medium.emplace();
    gas->medium->absorption_per_m = Spectrum(lines(2.0, 6.0, half, kPlaces, 1.0));
    sim.materials.push_back(gas);
    const Spectrum band = Spectrum::band(3.0, 5.0);
    const auto grid = fineGrid(band, sim);
    EXPECT_LE(grid.size(), 600u) << half;
    for (double length_m : {1e-3, 0.1, 1.0, 3.0, 10.0, 100.0, 1e4}) {
      const auto lost = [&](double w) { return -std::expm1(-gas->medium->absorption_per_m(w) * length_m); };
      double own = 0.0, whole = 0.0;
      for (const QuadratureNode& n : grid) own += n.weight * lost(n.x);
      // Each flank by its closed form: width (1 - (1 - exp(-t)) / t).
      whole = 2.0 * half * static_cast<double>(kPlaces.size()) *
              (length_m < 1e-2 ? length_m / 2.0 - length_m * length_m / 6.0 : 1.0 + std::expm1(-length_m) / length_m);
      double& of = half > 5e-3 ? wide : worst;
      of = std::max(of, std::abs(own / whole - 1.0));
    }
  }
  bound("curves of growth of triangular lines of half widths 1e-6 to 1e-3 um on the reference's grid, relative", worst, 5e-3,
        "wings cut where they fall by 1.5 each: 0.54 x 0.4^2 / 24 = 4e-3");
  bound("of lines of 0.03 um, seven bins", wide, 1.5e-2, "a bin's depth changes by a quarter of the line's: (10 / 4)^2 / 24 of the bin, of e^-2 of seven");
}

TEST(FineGrid, GasesOfThousandsOfLines) {
  // Absorption in rows 0.01 nm apart, 800 a bin of 5 1/cm, over five decades: a table of single lines.
  Spectrum::Table rough;
  rough.outside = Outside::Zero;
  unsigned seed = 5;
  for (int i = 0; i <= 60000; ++i) {
    seed = seed * 1664525u + 1013904223u;
    rough.wavelength_um.push_back(3.95 + 1e-5 * i);
    rough.value.push_back(std::pow(10.0, 5.0 * (seed >> 8) * 0x1p-24 - 4.0));
  }
  Simulation sim;
  auto gas = std::make_shared<Material>();
  gas->medium.emplace();
  gas->medium->absorption_per_m = Spectrum(rough);
  sim.materials.push_back(gas);
  const auto grid = fineGrid(Spectrum::band(4.0, 4.5), sim);
  double worst = 0.0;
  for (double length_m : {1e-3, 0.1, 1.0, 10.0, 1e3}) {
    const auto lost = [&](double w) { return -std::expm1(-gas->medium->absorption_per_m(w) * length_m); };
    double own = 0.0, whole = 0.0;
    for (const QuadratureNode& n : grid) own += n.weight * lost(n.x);
    // Between two rows absorption is linear: the mean of what passes has a closed form.
    for (size_t i = 5000; i < 55000; ++i) {
      const double a = rough.value[i] * length_m, b = rough.value[i + 1] * length_m;
      whole += 1e-5 * (1.0 - (std::abs(a - b) < 1e-6 ? std::exp(-a) : (std::exp(-a) - std::exp(-b)) / (b - a)));
    }
    worst = std::max(worst, std::abs(own / whole - 1.0));
  }
  bound("curves of growth of 50000 random rows of a gas, 800 a bin, on the reference's grid, relative", worst, 8e-3,
        "32 strengths a bin, a factor of 1.4 each, and eight places from row to row");
}

TEST(FineGrid, NarrowPeaksOfReflectance) {
  double worst = 0.0;
  for (double half : {2e-6, 1e-4, 5e-4})
    for (double base : {0.0, 0.05}) {
      Spectrum::Table t = lines(0.4, 0.8, half, {0.45003, 0.53219, 0.63281}, 0.9);
      for (double& v : t.value) v = std::max(v, base);
      Simulation sim;
      auto filter = std::make_shared<Material>();
      filter->reflections.push_back(makeLambertian(Spectrum(t)));
      filter->modifiers.push_back(-1);
      sim.materials.push_back(filter);
      const Spectrum band = Spectrum::band(0.42, 0.7), sun(Spectrum::BlackBody{5800.0, 1.0});
      double own = 0.0;
      for (const QuadratureNode& n : fineGrid(band, sim)) own += n.weight * sun(n.x) * filter->reflectance(n.x, 0.0);
      const double whole = integrate([&](double w) { return sun(w) * filter->reflectance(w, 0.0); }, 0.42, 0.7, filter->reflections[0]->knots_um());
      worst = std::max(worst, std::abs(own / whole - 1.0));
    }
  bound("sunlight off narrow peaks of a reflectance on the reference's grid, relative", worst, 1e-4, "bins end at their bends");
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

// Responses that differ by less than a factor of 3 of their mean ratio go over the same wavelengths; others don't.
TEST(FineGrid, AlikeResponsesShareWavelengths) {
  const auto table = [](std::vector<double> at, std::vector<double> value) {
    return Spectrum(Spectrum::Table{std::move(at), std::move(value), Outside::Hold, ""});
  };
  const Spectrum band = Spectrum::band(3.5, 5.0), rising = band * table({3.0, 4.013, 5.5}, {0.4, 0.8, 0.9}), scaled = band * 7.0,
                 peaked = band * table({3.0, 4.0, 4.1, 4.2, 5.5}, {0.01, 0.01, 1.0, 0.01, 0.01}), shorter = Spectrum::band(3.5, 4.9);
  EXPECT_TRUE(areAlike(band, rising));
  EXPECT_TRUE(areAlike(rising, band));
  EXPECT_TRUE(areAlike(band, scaled));
  EXPECT_FALSE(areAlike(band, peaked));
  EXPECT_FALSE(areAlike(band, shorter));
  EXPECT_FALSE(areAlike(band, band * 0.0));
  Simulation nothing;
  const Spectrum* const family[] = {&band, &rising, &scaled};
  const auto grids = fineGrids(family, nothing);
  ASSERT_EQ(grids.size(), 3u);
  const Spectrum black(Spectrum::BlackBody{500.0, 1.0});
  for (size_t k = 0; k < 3; ++k) {
    ASSERT_EQ(grids[k].size(), grids[0].size());
    double sum = 0.0, seen = 0.0;
    for (size_t i = 0; i < grids[k].size(); ++i) {
      EXPECT_EQ(grids[k][i].x, grids[0][i].x);
      sum += grids[k][i].weight, seen += grids[k][i].weight * black(grids[k][i].x);
    }
    figure("weights of kernel " + std::to_string(k), sum, family[k]->integral(3.5, 5.0), 1e-12, "integral of the kernel");
    figure("a black body in kernel " + std::to_string(k), seen, (*family[k] * black).integral(3.5, 5.0), 2e-5,
           "Gauss-Legendre between bends; bins of 0.3 % of a wavelength");
  }
}

}  // namespace
}  // namespace pitviper::test
