// Films of 1 to 100 um on the reference's wavelengths against Airy's formula integrated finely over the band: fringes are followed, or averaged.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <random>

#include "materials/facet_optics.hpp"
#include "materials/film_fringes.hpp"
#include "sim/plan/averaged_fringes.hpp"
#include "sim/plan/fine_grid.hpp"
#include "sim/plan/sampling_check.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

using Complex = std::complex<double>;

/// One film on a half space, by Airy's closed formula for each polarisation; nothing of the recursion's. Source: Born and Wolf, Principles of Optics, 7.6.
double airy(Complex n, double d, Complex beneath, double w, double sine) {
  const auto across = [&](Complex m) {
    const Complex q = std::sqrt(m * m - sine * sine);
    return q.imag() < 0.0 ? -q : q;
  };
  const Complex q0 = across(1.0), q1 = across(n), q2 = across(beneath), turn = std::exp(Complex(0.0, 4.0 * kPi * d / w) * q1);
  double sum = 0.0;
  for (bool parallel : {false, true}) {
    const auto at = [&](Complex a, Complex ma, Complex b, Complex mb) {
      const Complex x = parallel ? a * mb * mb : a, y = parallel ? b * ma * ma : b;
      return (x - y) / (x + y);
    };
    const Complex r01 = at(q0, 1.0, q1, n), r12 = at(q1, n, q2, beneath);
    sum += 0.5 * std::norm((r01 + r12 * turn) / (1.0 + r01 * r12 * turn));
  }
  return sum;
}

struct Means {
  double reflected = 0.0, emitted = 0.0;  ///< of sunlight of 5800 K, of a black body of 300 K; over those of a mirror and a black body
};

std::string written(Complex n) { return n.imag() == 0.0 ? print("%.17g", n.real()) : print("{n: %.17g, k: %.17g}", n.real(), n.imag()); }

Simulation filmOf(Complex n, double d, Complex beneath) {
  return scene("materials: {film: {components: [{reflection: microfacet, roughness: 0.002, index: " + written(beneath) + ", layers: [{index: " + written(n) +
               print(", thickness: %.17g um", d) +
               ", coherent: true}]}]}}\nentities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: film, temperature: 300 K}]\nprobes: "
               "[{name: p, position: [0 m, 0 m, 1 m], channels: [{name: a, response: {band: [8 um, 12 um]}, output: irradiance}]}]\n");
}

Means onGrid(const Simulation& sim, double low, double high, double angle, size_t& nodes) {
  const auto grid = fineGrid(Spectrum::band(low, high), sim);
  nodes = grid.size();
  const ReflectionComponent& facets = *sim.materials[0]->reflections[0];
  Means m;
  double sun = 0.0, black = 0.0;
  for (const auto& node : grid) {
    const double r = facets.column(node.x, angle, 0.0), s = node.weight * physics::planckRadiance(node.x, 5800.0),
                 b = node.weight * physics::planckRadiance(node.x, 300.0);
    m.reflected += s * r, sun += s, m.emitted += b * (1.0 - r), black += b;
  }
  return {m.reflected / sun, m.emitted / black};
}

Means finely(Complex n, double d, Complex beneath, double low, double high, double angle) {
  // Even steps of wave number, 96 a fringe and 4000 at least.
  const int steps = std::max(4000, static_cast<int>(96.0 * 2.0 * n.real() * d * (1.0 / low - 1.0 / high)));
  const double a = 1.0 / high, b = 1.0 / low, sine = std::sin(angle);
  Means m;
  double sun = 0.0, black = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double w = 1.0 / (a + (b - a) * (k + 0.5) / steps), r = airy(n, d, beneath, w, sine), s = w * w * physics::planckRadiance(w, 5800.0),
                 e = w * w * physics::planckRadiance(w, 300.0);
    m.reflected += s * r, sun += s, m.emitted += e * (1.0 - r), black += e;
  }
  return {m.reflected / sun, m.emitted / black};
}

const std::pair<double, double> kBands[] = {{0.45, 0.7}, {0.9, 1.7}, {1.5, 1.8}, {3.0, 5.0}, {3.9, 4.1}, {8.0, 12.0}, {9.5, 10.5}};

TEST(FilmFringes, AreAsFineQuadratureHasThem) {
  std::mt19937_64 random(39);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  double worst = 0.0, worstThermal = 0.0;
  size_t most = 0;
  for (int i = 0; i < 28; ++i) {  // four means of each band, absorbing or not, on a dielectric or a metal, by turns
    const Complex n(uniform(1.3, 4.0), i % 3 == 0 ? std::exp(uniform(std::log(1e-5), std::log(0.05))) : 0.0),
        beneath = i % 2 == 0 ? Complex(uniform(1.4, 1.8)) : Complex(uniform(0.3, 4.0), uniform(5.0, 30.0));
    const double d = i < 4 ? std::array{1.0, 10.0, 75.6, 100.0}[static_cast<size_t>(i)] : std::exp(uniform(0.0, std::log(100.0)));
    const Simulation sim = filmOf(n, d, beneath);
    const auto& [low, high] = kBands[i % 7];
    const double angle = (i % 4) * kPi / 9.0;  // entries of a facet's table: 0, 20, 40 and 60 degrees
    size_t nodes = 0;
    const Means own = onGrid(sim, low, high, angle, nodes), all = finely(n, d, beneath, low, high, angle);
    worst = std::max(worst, std::abs(own.reflected / all.reflected - 1.0));
    // Where a black body of 300 K shines: the visible's is that of its last nanometres.
    if (low > 2.0) worstThermal = std::max(worstThermal, std::abs(own.emitted / all.emitted - 1.0));
    most = std::max(most, nodes);
  }
  bound(
      "28 means of coherent films of 1 to 100 um over bands on the reference's wavelengths, reflected sunlight against Airy's formula by fine quadrature, "
      "relative",
      worst, 1e-3, "asked for");
  bound("the same, emission at 300 K in 3-5 and 8-12 um and parts of them", worstThermal, 1e-3, "asked for");
  std::printf("most wavelengths: %zu\n", most);
  EXPECT_LE(most, 6500u);  // eight a nanometre of 0.9 to 1.7 um
}

// What the plan and the reference both saw as 47 % more: a film of 100 um in the visible, whose fringes are as far apart as the bins.
TEST(FilmFringes, CloserThanBinsAreTheSumOfPowers) {
  double worst = 0.0;
  for (Complex n : {Complex(1.3), Complex(1.5), Complex(2.4), Complex(4.0), Complex(3.4, 1e-4)})
    for (Complex beneath : {Complex(1.5), Complex(1.0, 6.0)})
      for (double d : {76.0, 100.0}) {
        const double w = 0.35, sine = 0.5;
        const std::vector<FilmLayer> film{{n, d, true}}, apart{{n, d, false}};
        const FringeMean fringes(film, w);
        if (!(fringeApart_um(film, w) < 0.5e-3)) continue;
        const double mean = fringes.of(film, [&](const auto&l) { return filmPower(l, beneath, w, sine); }).reflectance,
                     sum = filmPower(apart, beneath, w, sine).reflectance;
        worst = std::max(worst, std::abs(mean / sum - 1.0));
      }
  bound("films whose fringes are closer than half a bin against the sum of powers, relative", worst, 4e-3,
        "1 % of the contrast of a fringe is left at half a bin, less beyond");
  EXPECT_GT(worst, 0.0);
}

// Several layers, and panes with films on both sides: stacks have no one fringe.
TEST(FilmFringes, OfStacks) {
  std::mt19937_64 random(391);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  double worst = 0.0;
  for (int i = 0; i < 12; ++i) {
    FacetSpec spec;
    spec.roughness = 0.002;
    spec.beneath = RefractiveIndex(Spectrum(1.52), Spectrum(0.0));
    const auto layer = [&](double thick) { return FilmSpec{RefractiveIndex(Spectrum(uniform(1.3, 4.0)), Spectrum(0.0)), thick, true, false}; };
    for (int k = 0; k < 1 + i % 3; ++k) spec.layers.push_back(layer(uniform(0.1, i % 2 ? 5.0 : 60.0)));
    if (i % 4 == 3) spec.paneThickness_um = 3000.0, spec.back.push_back(layer(uniform(1.0, 20.0)));
    const FacetOptics optics(spec);
    const auto& [low, high] = kBands[i % 7];
    Simulation nothing;
    double own = 0.0, weight = 0.0;
    for (const QuadratureNode& bin : fineGrid(Spectrum::band(low, high), nothing)) {
      // As the scene's grid cuts its bins.
      const double width = bin.weight;
      const int parts = std::max(1, static_cast<int>(std::ceil(width / optics.resolvedBy_um(bin.x))));
      for (int b = 0; b < parts; ++b) own += width / parts * optics.at(bin.x + width * ((b + 0.5) / parts - 0.5)).facet.front(), weight += width / parts;
    }
    double path = 0.0;
    std::vector<FilmLayer> layers;
    for (const FilmSpec& f : spec.layers) layers.push_back({f.index(1.0), f.thickness_um, true}), path += f.index(1.0).real() * f.thickness_um;
    Complex last = 1.52;
    if (spec.paneThickness_um) {
      layers.push_back({last, *spec.paneThickness_um, false});
      for (const FilmSpec& f : spec.back) layers.push_back({f.index(1.0), f.thickness_um, true}), path += f.index(1.0).real() * f.thickness_um;
      last = 1.0;
    }
    const int steps = std::max(4000, static_cast<int>(200.0 * path * (1.0 / low - 1.0 / high)));
    double fine = 0.0, of = 0.0;
    for (int k = 0; k < steps; ++k) {
      const double w = 1.0 / (1.0 / high + (1.0 / low - 1.0 / high) * (k + 0.5) / steps);
      fine += w * w * filmPower(layers, last, w, 0.0).reflectance, of += w * w;
    }
    worst = std::max(worst, std::abs(own / weight / (fine / of) - 1.0));
  }
  bound("12 stacks of one to three thick films and coated panes over bands, against fine quadrature, relative", worst, 2e-3,
        "powers of thick layers beneath each other; 20 bins are the least here");
}

TEST(FilmFringes, AreToldWhereTheyAreAveraged) {
  const auto told = [](double n, double d, const char* band, bool coherent = true) {
    const Simulation sim =
        scene("materials: {film: {components: [{reflection: microfacet, roughness: 0.002, index: 1.5, layers: [{index: " + print("%g", n) +
              print(", thickness: %g um, coherent: ", d) + (coherent ? "true" : "false") +
              "}]}]}}\nentities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: film, temperature: 300 K}]\ncameras: "
              "[{name: c, film: {width: 8, height: 8}, field_of_view: 5 deg, aperture: 40 mm, look_at: p, position: [9 m, 0 m, 0 m], channels: "
              "[{name: b, response: {band: " +
              band + "}}]}]\n");
    return averagedFringes(sim, sim.cameras[0].outputs);
  };
  // lambda^2 / (2 n d) against 1 nm below 1.41 um, 5 1/cm beyond.
  const auto visible = told(1.5, 100.0, "[0.45 um, 0.7 um]");
  ASSERT_EQ(visible.size(), 1u);
  figure("fringes of 100 um of n 1.5 at 0.45 um [nm]", 1e3 * visible[0].apart_um, 1e3 * 0.45 * 0.45 / 300.0, 1e-9, "lambda^2 / (2 n d)");
  EXPECT_EQ(visible[0].at_um, 0.45);
  EXPECT_FALSE(visible[0].narrow);
  EXPECT_NE(wordsOf(visible[0]).find("fringes of 'film' are 0.68 nm apart at 0.45 um"), std::string::npos) << wordsOf(visible[0]);
  EXPECT_TRUE(told(1.5, 100.0, "[3 um, 5 um]").empty());  // 33 1/cm apart
  EXPECT_TRUE(told(1.5, 100.0, "[8 um, 12 um]").empty());
  EXPECT_TRUE(told(1.5, 10.0, "[0.45 um, 0.7 um]").empty());
  EXPECT_TRUE(told(1.5, 100.0, "[0.45 um, 0.7 um]", false).empty());
  ASSERT_EQ(told(4.0, 40.0, "[0.52 um, 0.53 um]").size(), 1u);
  EXPECT_TRUE(told(4.0, 40.0, "[0.52 um, 0.53 um]")[0].narrow);
}

TEST(FilmFringes, FewSamplesThatStepOverThemAreTold) {
  const auto told = [](const char* spectral, double d, const char* band) {
    const Simulation sim = scene(
        print("materials: {film: {components: [{reflection: microfacet, roughness: 0.002, index: 1.5, layers: [{index: 2.4, thickness: %g um}]}]}}\n", d) +
        "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: film, temperature: 300 K}]\ncameras: "
        "[{name: c, film: {width: 8, height: 8}, field_of_view: 5 deg, aperture: 40 mm, look_at: p, position: [9 m, 0 m, 0 m], spectral: " +
        spectral + ", channels: [{name: b, response: {band: " + band + "}}]}]\n");
    const Camera& c = sim.cameras[0];
    return checkFringes(sim, makePlan(sim, c.outputs, c.spectral, c.where), c.outputs, 0.01);
  };
  EXPECT_EQ(told("{samples: 4, spacing: even}", 9.0, "[0.45 um, 0.7 um]").size(), 1u);
  EXPECT_EQ(told("{samples: 2}", 5.0, "[8 um, 12 um]").size(), 1u);
  EXPECT_EQ(told("{samples: 3}", 7.0, "[3 um, 5 um]").size(), 1u);
  EXPECT_TRUE(told("{samples: 512, spacing: even}", 9.0, "[0.45 um, 0.7 um]").empty());
  EXPECT_TRUE(told("{samples: 16}", 0.15, "[0.45 um, 0.7 um]").empty());
}

}  // namespace
}  // namespace pitviper::test
