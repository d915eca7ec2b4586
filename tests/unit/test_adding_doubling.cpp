// Adding and doubling against published tables of scattering layers and against closed forms.
//
// Rationale: layers of light and haze are told by this solver alone, so a wrong formula in it would be found nowhere else.
// Expectation: every printed digit of DISORT's test problems, which hold van de Hulst's (1980, table 12 and 35), Sweigart's (1970) and Devaux's figures; H
// functions of Chandrasekhar; nothing lost where nothing is absorbed; one radiance everywhere in a world of one temperature.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "sim/radiance/source_iteration.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/garcia_siewert.hpp"

namespace pitviper {
namespace {

std::vector<double> henyeyGreenstein(double g, int count) {
  std::vector<double> all;
  for (int l = 0; l < count; ++l) all.push_back(std::pow(g, l));
  return all;
}
const std::vector<double> kIsotropic{1.0}, kRayleigh{1.0, 0.0, 0.1};

/// Radiance towards a direction with a sine of elevation, on the sun's own azimuth or so far from it.
double radianceOf(const LayerLight& light, std::size_t edge, double sine, double azimuth_rad = 0.0) {
  std::size_t at = 0;
  while (std::abs(light.sines[at] - std::abs(sine)) > 1e-12) ++at;
  const std::size_t n = light.sines.size();
  double sum = (sine > 0.0 ? light.thermalUp : light.thermalDown)[edge * n + at];
  for (int m = 0; m < light.shape.azimuths; ++m)
    sum += std::cos(m * azimuth_rad) *
           (sine > 0.0 ? light.solarUp : light.solarDown)[(edge * static_cast<std::size_t>(light.shape.azimuths) + static_cast<std::size_t>(m)) * n + at];
  return sum;
}

/// A printed figure of six digits: half of the last one, and the rounding of inputs beside it.
void expectPrinted(double found, double printed, const char* what) { EXPECT_NEAR(found, printed, std::max(1e-5 * printed, 1e-12)) << what; }

struct Printed {
  const char* name;
  double depth, albedo;
  double sunSine, irradiance, space;
  std::vector<double> down, up;      ///< irradiance at the top and at the bottom
  std::vector<double> above, below;  ///< radiance: upwards at the top, downwards at the bottom, by rising sine
};

void expectAll(const std::vector<Printed>& cases, const std::vector<double>& moments, const std::vector<double>& sines) {
  for (const Printed& p : cases) {
    PlaneLayers layers;
    layers.layers = {{p.depth, p.albedo, moments}};
    layers.sunSine = p.sunSine, layers.irradiance = p.irradiance, layers.spaceRadiance = p.space;
    const LayerLight light = lightIn(layers, {16, 16, 0.005, sines});
    for (std::size_t edge : {0u, 1u}) {
      expectPrinted(light.fluxDown[edge], p.down[edge], p.name);
      expectPrinted(light.fluxUp[edge], p.up[edge], p.name);
    }
    for (std::size_t k = 0; k < sines.size(); ++k) {
      if (p.above.empty()) continue;
      expectPrinted(radianceOf(light, 0, sines[k]), p.above[k], p.name);
      expectPrinted(radianceOf(light, 1, -sines[k]), p.below[k], p.name);
    }
  }
}

// Source: Stamnes, Tsay, Wiscombe and Laszlo 2000, DISORT report 1.1, test problem 1: van de Hulst 1980, Multiple Light Scattering, table 12.
TEST(AddingDoubling, EvenScatteringIsVanDeHulsts) {
  const double f = kPi / 0.1;
  expectAll({{"1a", 0.03125, 0.2, 0.1, f, 0, {0, 7.94108e-2}, {7.99451e-2, 0}, {1.17771e-1, 2.64170e-2, 1.34041e-2}, {1.15898e-1, 2.63324e-2, 1.33826e-2}},
             {"1b", 0.03125, 1.0, 0.1, f, 0, {0, 4.20233e-1}, {4.22922e-1, 0}, {6.22884e-1, 1.39763e-1, 7.09192e-2}, {6.13458e-1, 1.39337e-1, 7.08109e-2}},
             {"1c", 0.03125, 0.99, 0.1, 0, 1, {kPi, 3.04897}, {9.06556e-2, 0}, {1.33177e-1, 2.99879e-2, 1.52233e-2}, {8.63946e-1, 9.69363e-1, 9.84447e-1}},
             {"1d", 32.0, 0.2, 0.1, f, 0, {0, 0}, {2.59686e-1, 0}, {2.62972e-1, 9.06967e-2, 5.02853e-2}, {0, 0, 0}},
             {"1e", 32.0, 1.0, 0.1, f, 0, {0, 6.76954e-2}, {3.07390, 0}, {1.93321, 1.02732, 7.97199e-1}, {1.16385e-2, 1.87805e-2, 2.71316e-2}},
             {"1f", 32.0, 0.99, 0.1, 0, 1, {kPi, 4.60048e-3}, {2.49618, 0}, {8.77510e-1, 8.15136e-1, 7.52715e-1}, {7.79280e-4, 1.26492e-3, 1.86840e-3}}},
            kIsotropic, {0.1, 0.5, 1.0});
}

// Source: as above, test problem 2: Sweigart 1970, Astrophys. J. Suppl. 22, 1, table 1.
TEST(AddingDoubling, MoleculesAreSweigarts) {
  const double s = 0.080442, f = kPi;
  expectAll({{"2a", 0.2, 0.5, s, f, 0, {0, 4.41791e-2}, {5.35063e-2, 0}, {1.61796e-1, 2.11501e-2, 7.86713e-3}, {2.57685e-2, 2.00778e-2, 7.71897e-3}},
             {"2b", 0.2, 1.0, s, f, 0, {0, 1.06123e-1}, {1.25561e-1, 0}, {3.47678e-1, 4.87120e-2, 1.89387e-2}, {6.77603e-2, 4.64061e-2, 1.86027e-2}},
             {"2c", 5.0, 0.5, s, f, 0, {0, 2.51683e-4}, {6.24730e-2, 0}, {1.62566e-1, 2.45786e-2, 1.01498e-2}, {1.32472e-5, 3.97168e-5, 1.70004e-4}},
             {"2d", 5.0, 1.0, s, f, 0, {0, 2.68008e-2}, {2.25915e-1, 0}, {3.64010e-1, 8.26993e-2, 4.92370e-2}, {3.79276e-3, 7.69337e-3, 1.05950e-2}}},
            kRayleigh, {0.018014, 0.538263, 0.981986});
}

// Source: as above, test problem 3: van de Hulst 1980, tables 35 and 37. Irradiance alone: the printed radiances have forward peaks put back.
TEST(AddingDoubling, ForwardPeaksAreVanDeHulsts) {
  expectAll({{"3a", 1.0, 1.0, 1.0, kPi, 0, {0, 1.73849}, {2.47374e-1, 0}, {}, {}}, {"3b", 8.0, 1.0, 1.0, kPi, 0, {0, 1.54958}, {1.59096, 0}, {}, {}}},
            henyeyGreenstein(0.75, 33), {});
}

// Source: as above, test problems 4 and 5: Garcia and Siewert 1985, Transp. Theory Stat. Phys. 14, 437, tables 12 to 16, 19 and 20, by their moments.
TEST(AddingDoubling, HazeAndCloudAreGarciaAndSiewerts) {
  struct Case {
    const char* name;
    bool isCloud;
    double albedo, sine;
    std::vector<double> depth, down, up;  ///< from the top; down: without the sun
  };
  const auto momentsOf = [](const std::vector<double>& printed) {
    std::vector<double> all{1.0};
    for (std::size_t l = 1; l <= printed.size(); ++l) all.push_back(printed[l - 1] / (2.0 * static_cast<double>(l) + 1.0));
    return all;
  };
  const std::vector<double> haze = momentsOf(test::kHazeL), cloud = momentsOf(test::kCloudC1);
  double worst = 0.0;
  for (const Case& c :
       {Case{"4a", false, 1.0, 1.0, {0.0, 0.5, 1.0}, {0.0, 1.17401, 1.81264}, {1.73223e-1, 1.11113e-1, 0.0}},
        Case{"4b", false, 0.9, 1.0, {0.0, 0.5, 1.0}, {0.0, 1.01517, 1.51554}, {1.23665e-1, 7.88690e-2, 0.0}},
        Case{"4c", false, 0.9, 0.5, {0.0, 0.5, 1.0}, {0.0, 7.02764e-1, 8.03294e-1}, {2.25487e-1, 1.23848e-1, 0.0}},
        Case{"5a", true, 1.0, 1.0, {0.0, 32.0, 64.0}, {0.0, 2.24768, 4.79851e-1}, {2.66174, 1.76783, 0.0}},
        Case{
            "5b", true, 0.9, 1.0, {0.0, 3.2, 12.8, 48.0, 64.0}, {NAN, 1.74767, 2.33975e-1, 6.38345e-5, NAN}, {NAN, 2.70485e-1, 3.74252e-2, 1.02904e-5, NAN}}}) {
    PlaneLayers layers;
    for (std::size_t k = 1; k < c.depth.size(); ++k) layers.layers.push_back({c.depth[k] - c.depth[k - 1], c.albedo, c.isCloud ? cloud : haze});
    layers.sunSine = c.sine, layers.irradiance = kPi;
    const LayerLight light = lightIn(layers, {c.isCloud ? 48 : 32, 1});
    for (std::size_t e = 0; e < c.depth.size(); ++e)
      for (const auto& [found, printed] : {std::pair{light.fluxDown[e], c.down[e]}, {light.fluxUp[e], c.up[e]}}) {
        if (!(printed > 0.0)) continue;
        worst = std::max(worst, std::abs(found / printed - 1.0));
        EXPECT_NEAR(found / printed, 1.0, 1e-5) << c.name << " edge " << e << ": " << found;
      }
  }
  std::printf("irradiance in haze L and cloud C.1 against Garcia and Siewert's, largest deviation %.1e\n", worst);
}

double bandRadiance(double temperature_K, double low_perCm, double high_perCm) {
  double sum = 0.0;
  for (const QuadratureNode& n : gaussLegendre(200, low_perCm, high_perCm))
    sum += n.weight * physics::planckRadiance(1e4 / n.x, temperature_K) * 1e4 / (n.x * n.x);
  return sum;
}
double allRadiance(double temperature_K) { return 5.670374419e-8 * std::pow(temperature_K, 4) / kPi; }

// Source: as above, test problems 7a, 7c and 7d (thermal light, of which 7a is Kylling's), printed with constants of 1986: 1e-5 besides the digits.
TEST(AddingDoubling, ThermalLightIsAsPrinted) {
  PlaneLayers a;
  a.layers = {{1.0, 0.1, henyeyGreenstein(0.05, 17), bandRadiance(200, 300, 800), bandRadiance(300, 300, 800)}};
  const LayerLight cold = lightIn(a, {16, 1});
  EXPECT_NEAR(cold.fluxUp[0] / 86.2936, 1.0, 3e-5);
  EXPECT_NEAR(cold.fluxDown[1] / 121.204, 1.0, 3e-5);
  for (const double albedo : {0.0, 1.0}) {
    PlaneLayers c;
    const double above = allRadiance(300), below = allRadiance(200), middle = 0.5 * (above + below);
    const auto moments = henyeyGreenstein(0.8, 13);
    c.layers = {{0.5, 0.5, moments, above, middle}, {0.5, 0.5, moments, middle, below}};
    c.sunSine = 0.5, c.irradiance = 200.0;
    c.spaceRadiance = 100.0 + allRadiance(100);
    c.groundAlbedo = albedo, c.groundEmission = (1.0 - albedo) * allRadiance(320);
    const LayerLight light = lightIn(c, {12, 12});
    const std::vector<double> up = albedo > 0.0 ? std::vector{312.563, 268.126, 305.596} : std::vector{429.572, 447.018, 594.576},
                              down = albedo > 0.0 ? std::vector{319.830, 350.555, 292.063} : std::vector{319.830, 354.099, 301.334};
    for (std::size_t e = 0; e < 3; ++e) {
      EXPECT_NEAR(light.fluxUp[e] / up[e], 1.0, 3e-5) << albedo << " " << e;
      EXPECT_NEAR(light.fluxDown[e] / down[e], 1.0, 3e-5) << albedo << " " << e;
    }
  }
}

// Source: as above, test problems 8 (Ozisik and Shouman 1980, table 1) and 9 (Devaux et al. 1979; 9c all at once).
TEST(AddingDoubling, SeveralLayersAreAsPrinted) {
  struct Two {
    double depth[2], albedo[2];
    std::vector<double> down, up, radiance;  ///< radiance of sines -1, -0.2, 0.2, 1 at each edge
  };
  for (const Two& t : {Two{{0.25, 0.25},
                           {0.5, 0.3},
                           {1.0, 7.22235e-1, 5.13132e-1},
                           {9.29633e-2, 2.78952e-2, 0},
                           {3.18310e-1, 3.18310e-1, 5.62566e-2, 1.94423e-2, 2.62711e-1, 1.36952e-1, 1.84909e-2, 5.52188e-3, 2.10014e-1, 5.60376e-2, 0, 0}},
                       Two{{0.25, 0.25},
                           {0.8, 0.95},
                           {1.0, 7.95332e-1, 6.50417e-1},
                           {2.25136e-1, 1.26349e-1, 0},
                           {3.18310e-1, 3.18310e-1, 1.23687e-1, 4.95581e-2, 2.77499e-1, 1.83950e-1, 8.35695e-2, 2.50575e-2, 2.40731e-1, 1.29291e-1, 0, 0}},
                       Two{{1.0, 2.0},
                           {0.8, 0.95},
                           {1.0, 4.86157e-1, 1.59984e-1},
                           {3.78578e-1, 2.43397e-1, 0},
                           {3.18310e-1, 3.18310e-1, 1.49335e-1, 1.04766e-1, 1.89020e-1, 9.88158e-2, 9.65192e-2, 6.54445e-2, 6.84762e-2, 2.96698e-2, 0, 0}}}) {
    PlaneLayers layers;
    layers.layers = {{t.depth[0], t.albedo[0], kIsotropic}, {t.depth[1], t.albedo[1], kIsotropic}};
    layers.spaceRadiance = 1.0 / kPi;
    const LayerLight light = lightIn(layers, {8, 1, 0.005, {0.2, 1.0}});
    for (std::size_t e = 0; e < 3; ++e) {
      expectPrinted(light.fluxDown[e], t.down[e], "8");
      expectPrinted(light.fluxUp[e], t.up[e], "8");
      std::size_t k = 4 * e;
      for (double sine : {-1.0, -0.2, 0.2, 1.0}) expectPrinted(radianceOf(light, e, sine), t.radiance[k++], "8");
    }
  }
  // Six layers of depths 1 to 6, looked at from between at depths 1.05 and 2.1.
  const std::vector<double> devaux{1.0,          2.00916 / 3.0,  1.56339 / 5.0,  0.67407 / 7.0, 0.22215 / 9.0,
                                   0.04725 / 11, 0.00671 / 13.0, 0.00068 / 15.0, 0.00005 / 17.0};
  const std::vector<double> depth{1.0, 0.05, 1.05, 0.9, 3.0, 4.0, 5.0, 6.0};
  const std::vector<int> layer{1, 2, 2, 2, 3, 4, 5, 6};
  const std::vector<std::size_t> looked{0, 2, 3, 5, 8};
  for (const char which : {'a', 'b', 'c'}) {
    PlaneLayers layers;
    double before = 0.0, inside = 0.0;
    for (std::size_t k = 0; k < depth.size(); ++k) {
      const double n = layer[k];
      if (k > 0 && layer[k] != layer[k - 1]) inside = 0.0;
      PlaneLayer own{depth[k], 0.6 + 0.05 * n, which == 'a' ? kIsotropic : which == 'b' ? devaux : henyeyGreenstein(n / 7.0, 9)};
      if (which == 'c') {
        // Temperatures at the edges of the six; the radiance is linear between.
        const double top = bandRadiance(600 + 10 * (n - 1), 999, 1000), bottom = bandRadiance(600 + 10 * n, 999, 1000);
        own.blackAbove = top + (bottom - top) * inside / n, own.blackBelow = top + (bottom - top) * (inside + depth[k]) / n;
      }
      inside += depth[k], before += depth[k];
      layers.layers.push_back(own);
    }
    layers.spaceRadiance = 1.0 / kPi;
    std::vector<double> down{1.0, 3.55151e-1, 1.44265e-1, 6.71445e-3, 6.16968e-7}, up{2.27973e-1, 8.75098e-2, 3.61819e-2, 2.19291e-3, 0};
    if (which == 'b') down = {1.0, 4.52357e-1, 2.36473e-1, 2.76475e-2, 7.41853e-5}, up = {1.00079e-1, 4.52014e-2, 2.41941e-2, 4.16016e-3, 0};
    if (which == 'c') {
      layers.sunSine = 0.5, layers.irradiance = kPi;
      layers.spaceRadiance = 1.0 + bandRadiance(550, 999, 1000);
      layers.groundAlbedo = 0.5, layers.groundEmission = 0.5 * bandRadiance(700, 999, 1000);
      down = {6.09217, 4.97279, 4.46616, 4.22731, 4.73767}, up = {4.68414, 4.24381, 4.16941, 4.30667, 5.11524};
    }
    const LayerLight light = lightIn(layers, {8, 8, 0.005, {0.2, 1.0}});
    for (std::size_t e = 0; e < looked.size(); ++e) {
      const double within = which == 'c' ? 3e-5 : 1e-5;  // c: constants of 1986
      EXPECT_NEAR(light.fluxDown[looked[e]] / down[e], 1.0, within) << which << e;
      EXPECT_NEAR(light.fluxUp[looked[e]], up[e], within * up[e]) << which << e;
    }
  }
}

// Source: Chandrasekhar 1960, Radiative Transfer, table XI: H of isotropic scattering; the diffuse reflection of a half-space is w F / (4 pi) s0 / (s + s0) H
// H.
TEST(AddingDoubling, DeepLayersAreChandrasekhars) {
  const auto rule = gaussLegendre(200, 0.0, 1.0);
  /// H by its integral equation in the form that converges, at the rule's points; and from these anywhere.
  const auto next = [&](double w, const std::vector<double>& all, double x) {
    double sum = 0.0;
    for (std::size_t i = 0; i < rule.size(); ++i) sum += rule[i].weight * rule[i].x * all[i] / (x + rule[i].x);
    return 1.0 / (std::sqrt(1.0 - w) + 0.5 * w * sum);
  };
  const auto pointsOf = [&](double w) {
    std::vector<double> all(rule.size(), 1.0);
    for (int turn = 0; turn < 400; ++turn) {
      std::vector<double> better;
      for (std::size_t i = 0; i < rule.size(); ++i) better.push_back(0.5 * (all[i] + next(w, all, rule[i].x)));
      all = better;
    }
    return all;
  };
  EXPECT_NEAR(next(1.0, pointsOf(1.0), 1.0), 2.9078, 1e-4);  // table XI
  const std::vector<double> sines{0.1, 0.5, 1.0};
  for (const double w : {0.2, 0.8, 0.975, 1.0}) {
    const std::vector<double> points = pointsOf(w);
    for (const double s0 : {0.2, 0.7, 1.0}) {
      PlaneLayers layers;
      layers.layers = {{w < 1.0 ? 1e3 : 1e6, w, kIsotropic}};
      layers.sunSine = s0, layers.irradiance = 1.0;
      const LayerLight light = lightIn(layers, {32, 1, 0.005, sines});
      for (double s : sines) {
        const double exact = w / (4.0 * kPi) * s0 / (s + s0) * next(w, points, s) * next(w, points, s0);
        EXPECT_NEAR(radianceOf(light, 0, s) / exact, 1.0, 2e-4) << w << " " << s << " " << s0;  // 32 streams at a sine of 0.1: 1e-4
      }
    }
  }
}

TEST(AddingDoubling, LosesNothingThatIsNotAbsorbed) {
  // Optical depths 1e-6 to 1e6, forward peaks to 0.999, sun from 90 degrees to below the horizon, white ground: what comes in goes out.
  std::mt19937_64 dice(7);
  const auto unit = [&] { return static_cast<double>(dice() >> 11) * 0x1p-53; };
  double worst = 0.0;
  for (int n = 0; n < 60; ++n) {
    PlaneLayers layers;
    for (int k = 0; k < 4; ++k) layers.layers.push_back({std::pow(10.0, 12.0 * unit() - 6.0), 1.0, henyeyGreenstein(n % 4 == 0 ? 0.999 : unit(), 40)});
    layers.sunSine = n % 5 == 0 ? 1.0 : 0.02 + 0.98 * unit(), layers.irradiance = 1.0, layers.groundAlbedo = 1.0, layers.spaceRadiance = unit();
    const LayerLight light = lightIn(layers, {8 + 8 * (n % 2), 4});
    for (double v : light.solar) EXPECT_TRUE(std::isfinite(v));
    const double in = light.fluxDown[0] + layers.sunSine * layers.irradiance;
    worst = std::max(worst, std::abs(light.fluxUp[0] / in - 1.0));
  }
  test::bound("conservative layers lose", worst, 1e-6, "adding and doubling, depths 1e-6 to 1e6");
}

TEST(AddingDoubling, OneTemperatureIsOneRadiance) {
  std::mt19937_64 dice(11);
  const auto unit = [&] { return static_cast<double>(dice() >> 11) * 0x1p-53; };
  for (int n = 0; n < 40; ++n) {
    PlaneLayers layers;
    for (int k = 0; k < 5; ++k)
      layers.layers.push_back({std::pow(10.0, 12.0 * unit() - 6.0), k == 2 ? 1.0 : unit(), henyeyGreenstein(0.95 * unit(), 40), 1.0, 1.0});
    layers.spaceRadiance = 1.0, layers.groundAlbedo = unit(), layers.groundEmission = 1.0 - layers.groundAlbedo;
    const LayerLight light = lightIn(layers, {8, 1, 0.005, {0.01, 0.7}});
    for (double v : light.thermalUp) EXPECT_NEAR(v, 1.0, 1e-8);
    for (double v : light.thermalDown) EXPECT_NEAR(v, 1.0, 1e-8);
    for (std::size_t e = 0; e < 6; ++e) {
      EXPECT_NEAR(light.thermalAt(e)[0], 4.0 * kPi, 1e-7);
      EXPECT_NEAR(light.thermalAt(e)[1], 0.0, 1e-7);
    }
  }
}

TEST(AddingDoubling, ReflectsAlikeBothWays) {
  // Reciprocity of a slab: f(a, b) = f(b, a), each told from a sun at the other's place.
  const std::vector<double> sines{0.15, 0.9};
  const auto sent = [&](double from, double to) {
    PlaneLayers layers;
    layers.layers = {{0.7, 0.9, henyeyGreenstein(0.5, 17)}, {3.0, 0.6, kRayleigh}};
    layers.groundAlbedo = 0.3;
    layers.sunSine = from, layers.irradiance = 1.0;
    return radianceOf(lightIn(layers, {16, 16, 0.005, sines}), 0, to, 1.0) / from;
  };
  EXPECT_NEAR(sent(0.15, 0.9) / sent(0.9, 0.15), 1.0, 1e-5);  // the first thin layer's error
}

TEST(AddingDoubling, TurnsLightAsItsPhaseFunctionDoes) {
  // Of light from one direction alone, moments Lambda(mu0) give the phase function back.
  const LayerLight::Shape shape{24, 24};
  const double g = 0.4, mu0 = -0.3, mu = 0.8, azimuth = 2.0;
  std::vector<double> to(static_cast<std::size_t>(shape.moments())), from(to.size());
  turnedTo(mu, std::cos(azimuth), shape, to);
  turnedTo(mu0, 1.0, shape, from);
  double sum = 0.0;
  for (int m = 0; m < shape.azimuths; ++m)
    for (int l = m; l < shape.streams; ++l) {
      const auto at = static_cast<std::size_t>(shape.at(l, m));
      sum += std::pow(g, l) * to[at] * (m == 0 ? 1.0 : 2.0) * from[at] * 4.0 * kPi / (2.0 * l + 1.0);
    }
  const double cosine = mu * mu0 + std::sqrt((1 - mu * mu) * (1 - mu0 * mu0)) * std::cos(azimuth);
  EXPECT_NEAR(sum / physics::henyeyGreensteinPhase(cosine, g), 1.0, 1e-8);  // 0.4^24
}

// What is turned by haze and by something evener, anywhere in two slabs of molecules under haze, by few streams and a finer look at their sources, against 64
// streams. The last figures are those of light between edges, which is told linear in depth.
TEST(SourceIteration, IsThatOfManyStreams) {
  const auto turned = [](const LayerLight& light, std::size_t edge, double mu, double azimuth, double g) {
    std::vector<double> to(static_cast<std::size_t>(light.shape.moments()));
    turnedTo(mu, std::cos(azimuth), light.shape, to);
    double sum = 0.0;
    for (int m = 0; m < light.shape.azimuths; ++m)
      for (int l = m; l < light.shape.streams; ++l) {
        const auto at = static_cast<std::size_t>(light.shape.at(l, m));
        sum += std::pow(g, l) * to[at] * light.solarAt(edge)[at];
      }
    return sum;
  };
  std::array<double, 3> worst{}, alone{};
  for (const double depth : {0.3, 3.0})
    for (const double sun : {0.1, 0.26, 0.77}) {
      PlaneLayers layers;
      const std::size_t count = depth > 1.0 ? 40 : 30;
      for (std::size_t k = 0; k < count; ++k) {
        const double haze = k < count / 2 ? 0.1 : 0.8;
        std::vector<double> moments;
        for (int l = 0; l < 64; ++l) moments.push_back(haze * std::pow(0.7, l) + (1.0 - haze) * (l == 0 ? 1.0 : l == 2 ? 0.1 : 0.0));
        layers.layers.push_back({depth / static_cast<double>(count), 0.95, moments});
      }
      layers.sunSine = sun, layers.irradiance = 1.0, layers.groundAlbedo = 0.2;
      const LayerLight exact = lightIn(layers, {64, 32});
      const std::array<std::pair<int, FineDirections>, 3> ways{{{8, {14, 16, 12}}, {12, {16, 20, 12}}, {16, {24, 24, 16}}}};
      for (std::size_t w = 0; w < ways.size(); ++w) {
        const LayerLight coarse = lightIn(layers, {ways[w].first, ways[w].first}), fine = finer(layers, coarse, ways[w].second);
        for (const std::size_t edge : {std::size_t{0}, count / 4, count / 2, count - 2, count})
          for (const double mu : {-0.95, -0.5, -0.1, -0.01, 0.03, 0.3, 0.8})
            for (const double azimuth : {0.0, 1.0, 2.0, 3.0})
              for (const double g : {0.3, 0.7}) {
                const double right = turned(exact, edge, mu, azimuth, g);
                worst[w] = std::max(worst[w], std::abs(turned(fine, edge, mu, azimuth, g) / right - 1.0));
                alone[w] = std::max(alone[w], std::abs(turned(coarse, edge, mu, azimuth, g) / right - 1.0));
              }
      }
    }
  test::bound("what 8 streams lose of light scattered again, looked at by 14 directions", worst[0], 0.02, "64 streams");
  test::bound("the same of 12 streams, 16 directions", worst[1], 0.015, "64 streams; between edges of layers light is linear");
  test::bound("the same of 16 streams, 24 directions", worst[2], 0.015, "64 streams; the same");
  EXPECT_LT(worst[0], 0.3 * alone[0]);
}

}  // namespace
}  // namespace pitviper
