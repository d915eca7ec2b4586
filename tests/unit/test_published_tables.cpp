// The plane-layer solver against further published numbers: every figure DISORT prints for a Lambert ground, with its radiances and heating; van de Hulst's
// and Chandrasekhar's tables; light with polarisation; extremes.
//
// Rationale: radiances where phase functions are peaked, many layers, azimuths and all sources at once are what a viewer sees of haze and cloud;
// test_adding_doubling.cpp holds their irradiance.
// Expectation: the printed digits, six of them, at the printed run's streams and moments.
// Source of "DISORT n": Stamnes, Tsay, Wiscombe and Laszlo 2000, DISORT report 1.1 (STWL), test problem n, as printed in its DISOTEST.f, BLOCK DATA CHEKDO (14
// digits carried, 6 printed). Left out: 6d, 6e, 7e and what goes up in 6f to 6h, whose ground is Hapke's and not even; 10 to 13 compare the program to itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "sim/radiance/adding_doubling.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/garcia_siewert.hpp"

namespace pitviper {
namespace {

namespace published {

/// Six digits are printed: half a unit of the last, and a tenth for what the first thin layer loses.
constexpr double kHalfDigit = 0.6;
double digitsOff(double found, double printed) { return std::abs(found - printed) / std::pow(10.0, std::floor(std::log10(std::abs(printed))) - 5.0); }

std::vector<double> peaked(double g, int last) {
  std::vector<double> all;
  for (int l = 0; l <= last; ++l) all.push_back(std::pow(g, l));
  return all;
}
/// From (2 l + 1) chi_l, l from 1 on.
std::vector<double> momentsOf(const std::vector<double>& printed, std::size_t last) {
  std::vector<double> all{1.0};
  for (std::size_t l = 1; l <= std::min(last, printed.size()); ++l) all.push_back(printed[l - 1] / (2.0 * static_cast<double>(l) + 1.0));
  return all;
}
const std::vector<double> kEven{1.0}, kMolecules{1.0, 0.0, 0.1};

double radianceAt(const LayerLight& light, std::size_t edge, double mu, double azimuth_rad) {
  const std::size_t n = light.sines.size(), azimuths = static_cast<std::size_t>(light.shape.azimuths);
  std::size_t at = 0;
  while (std::abs(light.sines[at] - std::abs(mu)) > 1e-12) ++at;
  double sum = (mu > 0.0 ? light.thermalUp : light.thermalDown)[edge * n + at];
  for (std::size_t m = 0; m < azimuths; ++m)
    sum += std::cos(static_cast<double>(m) * azimuth_rad) * (mu > 0.0 ? light.solarUp : light.solarDown)[(edge * azimuths + m) * n + at];
  return sum;
}

double phaseOf(const std::vector<double>& moments, double cosine) {
  double sum = 0.0, here = 1.0, before = 0.0;
  for (std::size_t l = 0; l < moments.size(); ++l) {
    const double degree = static_cast<double>(l);
    sum += (2.0 * degree + 1.0) * moments[l] * here;
    const double next = ((2.0 * degree + 1.0) * cosine * here - degree * before) / (degree + 1.0);
    before = here, here = next;
  }
  return sum;
}

/// What DISORT adds to radiance for the forward peaks taken off: sunlight turned once by the whole phase function (TMS), and near the sun twice (IMS).
/// Source: Nakajima and Tanaka 1988, J. Quant. Spectrosc. Radiat. Transfer 40, 51; STWL equations 68, 72 and A.13 to A.15.
double peaksPutBack(const PlaneLayers& all, int streams, std::size_t edge, double mu, double azimuth_rad) {
  const auto n = static_cast<std::size_t>(streams);
  const double sun = all.sunSine, cosine = -sun * mu + std::sqrt((1.0 - sun * sun) * (1.0 - mu * mu)) * std::cos(azimuth_rad);
  std::vector<double> depth{0.0};  // less the peaks
  for (const PlaneLayer& l : all.layers) depth.push_back(depth.back() + l.depth * (1.0 - l.albedo * (l.moments.size() > n ? l.moments[n] : 0.0)));
  double sum = 0.0, peak = 0.0, whole = 0.0;  // the last two: over the layers above, of depths that turn light into peaks, and all
  std::vector<double> moments;                // of what is turned there
  for (std::size_t k = 0; k < all.layers.size(); ++k) {
    const PlaneLayer& l = all.layers[k];
    const double f = l.moments.size() > n ? l.moments[n] : 0.0;
    std::vector<double> left;
    for (std::size_t i = 0; i < std::min(n, l.moments.size()); ++i) left.push_back((l.moments[i] - f) / (1.0 - f));
    const double more = l.albedo / (1.0 - f * l.albedo) * (phaseOf(l.moments, cosine) - (1.0 - f) * phaseOf(left, cosine));
    if (k >= edge && mu > 0.0) {
      const auto reached = [&](double t) { return std::exp(-(t - depth[edge]) / mu - t / sun); };
      sum += more / (1.0 + mu / sun) * (reached(depth[k]) - reached(depth[k + 1]));
    } else if (k < edge && mu < 0.0) {
      const auto reached = [&](double t) { return std::exp((depth[edge] - t) / mu - t / sun); };
      sum += std::abs(mu + sun) < 1e-12 ? more * reached(depth[k]) * (depth[k + 1] - depth[k]) / sun
                                        : more / (1.0 + mu / sun) * (reached(depth[k + 1]) - reached(depth[k]));
    }
    if (k >= edge) continue;
    peak += l.albedo * l.depth * f, whole += l.depth;
    moments.resize(std::max(moments.size(), l.moments.size()), 0.0);
    for (std::size_t i = 0; i < l.moments.size(); ++i) moments[i] += l.albedo * l.depth * l.moments[i];
  }
  if (mu < 0.0 && peak > 1e-4 && std::abs(std::acos(sun) - std::acos(-mu)) <= kPi / 18.0) {
    for (std::size_t i = 0; i < moments.size(); ++i) {
      const double g = i < n ? 1.0 : moments[i] / peak;
      moments[i] = g * (2.0 - g);
    }
    const double share = peak / whole, s = sun / (1.0 - share), x = -1.0 / mu - 1.0 / s;
    const double xi = std::abs(x) < 1e-12 ? 0.5 * whole * whole * std::exp(-whole / s) / (-mu * s)
                                          : ((whole * x - 1.0) * std::exp(-whole / s) + std::exp(whole / mu)) / (x * x * -mu * s);
    sum -= share * share / (1.0 - share) * phaseOf(moments, cosine) * xi;
  }
  return all.irradiance / (4.0 * kPi) * sum;
}

struct PrintedRun {
  const char* name;
  PlaneLayers layers;
  Streams streams;
  std::vector<std::size_t> edges;
  std::vector<double> mus, azimuths_deg;
  std::vector<double> down, up, change;  ///< irradiance without the sun itself; of all light's net irradiance, what a unit of depth takes
  std::vector<double> radiance;          ///< [azimuth][edge][mu]
};

/// Largest deviation from what is printed, in units of the last digit.
double worstOf(const PrintedRun& p) {
  double worst = 0.0;
  const auto expect = [&](double found, double printed, double scale, const char* what, std::size_t e, double mu, double azimuth) {
    if (printed == 0.0) {
      EXPECT_NEAR(found, 0.0, 1e-9 * scale) << p.name << " " << what << " at level " << e << ", direction " << mu << ", azimuth " << azimuth;
      return;
    }
    worst = std::max(worst, digitsOff(found, printed));
    EXPECT_LE(digitsOff(found, printed), kHalfDigit) << p.name << " " << what << " " << found << " for " << printed << " at level " << e << ", " << mu << ", "
                                                     << azimuth;
  };
  const LayerLight light = lightIn(p.layers, p.streams);
  const double most = p.down.empty() ? 1.0 : std::max(*std::max_element(p.down.begin(), p.down.end()), p.layers.irradiance);
  for (std::size_t e = 0; e < p.edges.size(); ++e) {
    const std::size_t edge = p.edges[e];
    if (!p.down.empty()) expect(light.fluxDown[edge], p.down[e], most, "down", e, 0, 0);
    if (!p.up.empty()) expect(light.fluxUp[edge], p.up[e], most, "up", e, 0, 0);
    // The level belongs to the layer above it.
    const PlaneLayer& own = p.layers.layers[edge > 0 ? edge - 1 : 0];
    double above = 0.0;
    for (std::size_t k = 0; k < edge; ++k) above += p.layers.layers[k].depth;
    const double all = light.solarAt(edge)[0] + light.thermalAt(edge)[0] + p.layers.irradiance * std::exp(-above / p.layers.sunSine);
    const double black = edge > 0 ? own.blackBelow : own.blackAbove;
    if (!p.change.empty()) expect((1.0 - own.albedo) * (all - 4.0 * kPi * black), p.change[e], all + 4.0 * kPi * black, "change", e, 0, 0);
  }
  if (p.radiance.empty()) return worst;
  EXPECT_EQ(p.radiance.size(), p.azimuths_deg.size() * p.edges.size() * p.mus.size()) << p.name;
  std::size_t at = 0;
  for (double azimuth : p.azimuths_deg)
    for (std::size_t e = 0; e < p.edges.size(); ++e)
      for (double mu : p.mus) {
        const double rad = azimuth * kPi / 180.0;
        double found = radianceAt(light, p.edges[e], mu, rad);
        if (p.layers.irradiance > 0.0) found += peaksPutBack(p.layers, p.streams.all, p.edges[e], mu, rad);
        expect(found, p.radiance[at++], most, "radiance", e, mu, azimuth);
      }
  return worst;
}

void expectPrintedDigits(const std::vector<PrintedRun>& cases, const char* what) {
  double worst = 0.0;
  for (const PrintedRun& p : cases) worst = std::max(worst, worstOf(p));
  test::bound(what, worst, kHalfDigit, "units of the sixth digit; rounding: 0.5");
}

PlaneLayers sunlit(std::vector<PlaneLayer> layers, double sine, double irradiance) {
  PlaneLayers all;
  all.layers = std::move(layers), all.sunSine = sine, all.irradiance = irradiance;
  return all;
}

const std::vector<double> kSixWays{-1.0, -0.5, -0.1, 0.1, 0.5, 1.0}, kThreeSines{0.1, 0.5, 1.0};

/// DISORT's black body: constants of 1973 (PLKAVG), between wavenumbers [1/cm]; and all of it.
constexpr double kSigma1973 = 5.67032e-8, kSecond1973_cmK = 1.438786;
double blackBetween(double temperature_K, double low_perCm, double high_perCm) {
  double sum = 0.0;
  for (const QuadratureNode& n : gaussLegendre(64, kSecond1973_cmK * low_perCm / temperature_K, kSecond1973_cmK * high_perCm / temperature_K))
    sum += n.weight * n.x * n.x * n.x / std::expm1(n.x);
  return 15.0 / std::pow(kPi, 4) * kSigma1973 * std::pow(temperature_K, 4) / kPi * sum;
}
double blackAll(double temperature_K) { return kSigma1973 * std::pow(temperature_K, 4) / kPi; }

}  // namespace published

// DISORT 1 (van de Hulst 1980, Multiple Light Scattering, table 12) and 2 (Sweigart 1970, Astrophys. J. Suppl. 22, 1, table 1): what a unit of depth absorbs;
// the rest is in test_adding_doubling.cpp.
TEST(PublishedTables, ThinAndDeepLayersAbsorbAsPrinted) {
  using namespace published;
  const auto even = [](double depth, double albedo, double irradiance, double space) {
    PlaneLayers all = sunlit({{depth, albedo, kEven}}, 0.1, irradiance);
    all.spaceRadiance = space;
    return all;
  };
  const auto molecules = [](double depth, double albedo) { return sunlit({{depth, albedo, kMolecules}}, 0.080442, kPi); };
  const Streams streams{16, 16};
  const double f = kPi / 0.1;
  expectPrintedDigits({{"1a", even(0.03125, 0.2, f, 0), streams, {0, 1}, {}, {}, {}, {}, {2.54067e1, 1.86531e1}, {}},
                       {"1b", even(0.03125, 1.0, f, 0), streams, {0, 1}, {}, {}, {}, {}, {0, 0}, {}},
                       {"1c", even(0.03125, 0.99, 0, 1), streams, {0, 1}, {}, {}, {}, {}, {6.66870e-2, 5.88936e-2}, {}},
                       {"1d", even(32.0, 0.2, f, 0), streams, {0}, {}, {}, {}, {}, {2.57766e1}, {}},
                       {"1e", even(32.0, 1.0, f, 0), streams, {0, 1}, {}, {}, {}, {}, {0, 0}, {}},
                       {"1f", even(32.0, 0.99, 0, 1), streams, {0, 1}, {}, {}, {}, {}, {1.14239e-1, 7.93633e-5}, {}},
                       {"2a", molecules(0.2, 0.5), streams, {0, 1}, {}, {}, {}, {}, {1.66570, 1.89848e-1}, {}},
                       {"2b", molecules(0.2, 1.0), streams, {0, 1}, {}, {}, {}, {}, {0, 0}, {}},
                       {"2c", molecules(5.0, 0.5), streams, {0, 1}, {}, {}, {}, {}, {1.67462, 1.75464e-4}, {}},
                       {"2d", molecules(5.0, 1.0), streams, {0, 1}, {}, {}, {}, {}, {0, 0}, {}}},
                      "DISORT 1 and 2, absorbed per depth");
}

// DISORT 3: van de Hulst 1980, table 37, g = 0.75, 16 streams, 33 moments.
TEST(PublishedTables, ForwardPeaksAreVanDeHulsts) {
  using namespace published;
  const Streams streams{16, 16, 0.005, kThreeSines};
  const std::vector<double> of3a{0, 0, 0, 1.51159e-1, 1.01103e-1, 3.95460e-2, 3.05855, 2.66648e-1, 2.13750e-1, 0, 0, 0};
  const std::vector<double> of3b{0, 0, 0, 3.79740e-1, 5.19598e-1, 4.93302e-1, 6.69581e-1, 4.22350e-1, 2.36362e-1, 0, 0, 0};
  expectPrintedDigits(
      {{"3a", sunlit({{1.0, 1.0, peaked(0.75, 32)}}, 1.0, kPi), streams, {0, 1}, kSixWays, {0.0}, {0.0, 1.73849}, {2.47374e-1, 0.0}, {0.0, 0.0}, of3a},
       {"3b", sunlit({{8.0, 1.0, peaked(0.75, 32)}}, 1.0, kPi), streams, {0, 1}, kSixWays, {0.0}, {0.0, 1.54958}, {1.59096, 0.0}, {0.0, 0.0}, of3b}},
      "DISORT 3, a peaked phase function");
}

// DISORT 4 and 5: Garcia and Siewert 1985, Transp. Theory Stat. Phys. 14, 437, tables 12 to 16, 19 and 20: 32 streams and 33 moments, 48 streams and 299.
TEST(PublishedTables, HazeAndCloudAreGarciaAndSiewerts) {
  using namespace published;
  const std::vector<double> haze = momentsOf(test::kHazeL, 32);
  // The last of cloud C.1, l from 229 to 299, in DISORT's GETMOM.
  std::vector<double> printed = test::kCloudC1;
  for (double v : {29, 27, 26, 24, 23, 22, 21, 20, 18, 18, 17, 16, 15, 14, 13, 13, 12, 11, 11, 10, 9, 9, 8, 8, 8, 7, 7, 6, 6, 6, 5, 5, 5, 5, 4, 4,
                   4,  4,  3,  3,  3,  3,  3,  3,  2,  2,  2,  2,  2,  2,  2,  2,  2,  1,  1,  1,  1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1})
    printed.push_back(1e-3 * v);
  const std::vector<double> cloud = momentsOf(printed, 298);  // GETMOM leaves the last one out
  ASSERT_EQ(printed.size(), 299u);
  const Streams few{32, 32, 0.005, kThreeSines}, many{48, 1, 0.005, kThreeSines};
  const auto inHaze = [&](double albedo, double sine) { return sunlit({{0.5, albedo, haze}, {0.5, albedo, haze}}, sine, kPi); };
  const std::vector<double> of4a{0,          0,          0,          9.26837e-2, 6.59569e-2, 3.64755e-2, 2.51608, 1.19287e-1, 1.34962e-1,
                                 1.23887e-1, 4.02058e-2, 1.77746e-2, 3.37302,    2.19835e-1, 1.56893e-1, 0,       0,          0};
  const std::vector<double> of4b{0,          0,          0,          6.53056e-2, 4.55144e-2, 2.82693e-2, 2.24258, 9.66049e-2, 9.61335e-2,
                                 8.43278e-2, 2.79473e-2, 1.38835e-2, 2.97057,    1.67698e-1, 1.08115e-1, 0,       0,          0};
  const std::vector<double> of4c{0,          0,          0,          8.70812e-1, 2.24960e-1, 2.27572e-2, 4.77016e-2, 3.02631,    1.41195,
                                 6.97692e-1, 1.09130e-1, 9.32861e-3, 8.38488e-2, 2.70538,    8.76523e-1, 0,          0,          0,
                                 0,          0,          0,          8.88117e-2, 5.77411e-2, 2.27572e-2, 4.77016e-2, 5.80971e-2, 1.04502e-1,
                                 9.16071e-2, 2.95842e-2, 9.32861e-3, 8.38488e-2, 9.42187e-2, 8.95457e-2, 0,          0,          0,
                                 0,          0,          0,          6.98247e-2, 5.02877e-2, 2.27572e-2, 4.77016e-2, 2.58544e-2, 6.25954e-2,
                                 5.91273e-2, 2.47702e-2, 9.32861e-3, 8.38488e-2, 3.99383e-2, 4.67155e-2, 0,          0,          0};
  const std::vector<double> of5a{0,          0,          0,          4.58927e-1, 7.72983e-1, 1.07196,    7.53662e-1, 6.96362e-1, 6.50541e-1,
                                 6.27631e-1, 5.81809e-1, 5.24532e-1, 1.95230e-1, 1.31990e-1, 7.20655e-2, 0,          0,          0};
  const std::vector<double> of5b{6.79623e1,  2.21027e-1, 1.36619e-1, 1.14084e-1, 8.73870e-2, 8.81626e-2, 2.05706e-1, 4.92736e-2, 2.65449e-2,
                                 2.02154e-2, 1.29661e-2, 9.51334e-3, 3.41286e-5, 1.39916e-5, 7.47039e-6, 5.65602e-6, 3.58245e-6, 2.57858e-6};
  expectPrintedDigits({{"4a", inHaze(1.0, 1.0), few, {0, 1, 2}, kSixWays, {0.0}, {0.0, 1.17401, 1.81264}, {1.73223e-1, 1.11113e-1, 0.0}, {0, 0, 0}, of4a},
                       {"4b",
                        inHaze(0.9, 1.0),
                        few,
                        {0, 1, 2},
                        kSixWays,
                        {0.0},
                        {0.0, 1.01517, 1.51554},
                        {1.23665e-1, 7.88690e-2, 0.0},
                        {3.43724e-1, 3.52390e-1, 3.19450e-1},
                        of4b},
                       {"4c",
                        inHaze(0.9, 0.5),
                        few,
                        {0, 1, 2},
                        kSixWays,
                        {0.0, 90.0, 180.0},
                        {0.0, 7.02764e-1, 8.03294e-1},
                        {2.25487e-1, 1.23848e-1, 0.0},
                        {3.85003e-1, 3.37317e-1, 2.16403e-1},
                        of4c},
                       {"5a",
                        sunlit({{32.0, 1.0, cloud}, {32.0, 1.0, cloud}}, 1.0, kPi),
                        many,
                        {0, 1, 2},
                        kSixWays,
                        {0.0},
                        {0.0, 2.24768, 4.79851e-1},
                        {2.66174, 1.76783, 0.0},
                        {0, 0, 0},
                        of5a},
                       {"5b",
                        sunlit({{3.2, 0.9, cloud}, {9.6, 0.9, cloud}, {35.2, 0.9, cloud}, {16.0, 0.9, cloud}}, 1.0, kPi),
                        many,
                        {1, 2, 3},
                        kSixWays,
                        {0.0},
                        {1.74767, 2.33975e-1, 6.38345e-5},
                        {2.70485e-1, 3.74252e-2, 1.02904e-5},
                        {3.10129e-1, 4.52671e-2, 1.25021e-5},
                        of5b}},
                      "DISORT 4 and 5, haze L and cloud C.1");
}

// DISORT 6: nothing scatters, 16 streams. Of 6f to 6h, whose ground is not even, what goes down.
TEST(PublishedTables, LayersThatOnlyAbsorbAreAsPrinted) {
  using namespace published;
  const auto clear = [](std::vector<double> depths, double albedo, double top_K, double bottom_K, double space) {
    PlaneLayers all = sunlit({}, 0.5, 200.0);
    double whole = 0.0, above = 0.0;
    for (double d : depths) whole += d;
    const double top = blackAll(top_K), bottom = blackAll(bottom_K);
    for (double d : depths) {
      all.layers.push_back({d, 0.0, kEven, top + (bottom - top) * (whole > 0.0 ? above / whole : 0.0), bottom});
      above += d;
      if (whole > 0.0) all.layers.back().blackBelow = top + (bottom - top) * above / whole;
    }
    all.groundAlbedo = albedo, all.spaceRadiance = space;
    return all;
  };
  const Streams streams{16, 1, 0.005, {0.1, 1.0}};
  const std::vector<double> ways{-1.0, -0.1, 0.1, 1.0}, downwards{-1.0, -0.1}, depths{0.5, 0.5};
  const double space = 100.0 / kPi + blackAll(250);
  const std::vector<double> of6a{0, 0, 0, 0, 0, 0, 0, 0};
  const std::vector<double> of6b{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  const std::vector<double> of6c{0, 0, 9.77882e-5, 7.92386e-1, 0, 0, 1.45131e-2, 1.30642, 0, 0, 2.15393, 2.15393};
  const std::vector<double> of6f{1.02336e2, 1.02336e2, 6.20697e1, 6.89532e-1, 3.76472e1, 4.64603e-3};
  const std::vector<double> of6g{1.02336e2, 1.02336e2, 9.78748e1, 1.01048e2, 1.10061e2, 1.38631e2};
  const std::vector<double> of6h{1.02336e2, 1.02336e2, 8.49992e1, 7.73186e1, 1.38631e2, 1.45441e2};
  expectPrintedDigits(
      {{"6a", clear({0.0}, 0, 0, 0, 0), streams, {0, 1}, ways, {90.0}, {0, 0}, {0, 0}, {200.0, 200.0}, of6a},
       {"6b", clear(depths, 0, 0, 0, 0), streams, {0, 1, 2}, ways, {90.0}, {0, 0, 0}, {0, 0, 0}, {2e2, 7.35759e1, 2.70671e1}, of6b},
       {"6c", clear(depths, 0.5, 0, 0, 0), streams, {0, 1, 2}, ways, {90.0}, {0, 0, 0}, {1.48450, 2.99914, 6.76676}, {2.02010e2, 7.79962e1, 4.06006e1}, of6c},
       {"6f", clear(depths, 0, 0, 0, space), streams, {0, 1, 2}, downwards, {90.0}, {3.21497e2, 1.42493e2, 7.05305e1}, {}, {}, of6f},
       {"6g", clear(depths, 0, 250, 300, space), streams, {0, 1, 2}, downwards, {90.0}, {3.21497e2, 3.04775e2, 3.63632e2}, {}, {}, of6g},
       {"6h", clear({1.0, 9.0}, 0, 250, 300, space), streams, {0, 1, 2}, downwards, {90.0}, {3.21497e2, 2.55455e2, 4.43444e2}, {}, {}, of6h}},
      "DISORT 6, no scattering");
}

// DISORT 7: thermal light (7a: Kylling and Stamnes 1992, J. Comp. Phys. 102, 265), and all sources.
TEST(PublishedTables, AllSourcesAreAsPrinted) {
  using namespace published;
  PlaneLayers a, b, c;
  a.layers = {{1.0, 0.1, peaked(0.05, 16), blackBetween(200, 300, 800), blackBetween(300, 300, 800)}};
  b.layers = {{100.0, 0.95, peaked(0.75, 16), blackBetween(200, 2702.99, 2703.01), blackBetween(300, 2702.99, 2703.01)}};
  const double above = blackAll(300), below = blackAll(200), middle = 0.5 * (above + below);
  c = sunlit({{0.5, 0.5, peaked(0.8, 12), above, middle}, {0.5, 0.5, peaked(0.8, 12), middle, below}}, 0.5, 200.0);
  c.spaceRadiance = 100.0 + blackAll(100), c.groundEmission = blackAll(320);
  PlaneLayers d = c;
  d.groundAlbedo = 1.0, d.groundEmission = 0.0;
  const Streams sixteen{16, 1, 0.005, {1.0}}, twelve{12, 12, 0.005, {0.1, 1.0}};
  const std::vector<double> ways{-1.0, -0.1, 0.1, 1.0};
  const std::vector<double> of7c{1.01805e2, 1.01805e2, 1.46775e2, 1.49033e2, 1.06583e2, 1.28565e2, 1.04464e2, 1.59054e2,
                                 9.66519e1, 8.65854e1, 1.89259e2, 1.89259e2, 1.01805e2, 1.01805e2, 1.29641e2, 1.49033e2,
                                 1.06583e2, 1.06408e2, 9.48418e1, 1.59054e2, 9.66519e1, 7.49310e1, 1.89259e2, 1.89259e2};
  const std::vector<double> of7d{1.01805e2, 1.01805e2, 1.40977e2, 9.62764e1, 1.06203e2, 1.23126e2, 9.19545e1, 8.89528e1,
                                 9.56010e1, 7.25576e1, 9.72743e1, 9.72743e1, 1.01805e2, 1.01805e2, 1.23843e2, 9.62764e1,
                                 1.06203e2, 1.00969e2, 8.23318e1, 8.89528e1, 9.56010e1, 6.09031e1, 9.72743e1, 9.72743e1};
  expectPrintedDigits(
      {{"7a", a, sixteen, {0, 1}, {}, {}, {0, 1.21204e2}, {8.62936e1, 0}, {-5.13731e1, -5.41036e2}, {}},
       {"7b", b, sixteen, {0, 1}, {-1.0, 1.0}, {0.0}, {0, 2.07786e-5}, {1.10949e-6, 0}, {8.23219e-8, -5.06461e-6}, {0, 4.65744e-7, 7.52311e-6, 0}},
       {"7c",
        c,
        twelve,
        {0, 1, 2},
        ways,
        {0.0, 90.0},
        {3.19830e2, 3.54099e2, 3.01334e2},
        {4.29572e2, 4.47018e2, 5.94576e2},
        {-8.04270e1, 2.51589e2, 7.15964e2},
        of7c},
       {"7d",
        d,
        twelve,
        {0, 1, 2},
        ways,
        {0.0, 90.0},
        {3.19830e2, 3.50555e2, 2.92063e2},
        {3.12563e2, 2.68126e2, 3.05596e2},
        {-1.68356e2, 1.01251e2, 4.09326e2},
        of7d}},
      "DISORT 7, thermal light and all sources");
}

// DISORT 8 (Ozisik and Shouman 1980, J. Quant. Spectrosc. Radiat. Transfer 24, 441, table 1) and 9 (Devaux et al. 1979, tables 6 and 7; 9c all at once).
TEST(PublishedTables, LayersThatDifferAreAsPrinted) {
  using namespace published;
  const Streams streams{8, 8, 0.005, {0.2, 1.0}};
  const std::vector<double> ways{-1.0, -0.2, 0.2, 1.0};
  const auto two = [](double first, double second, double depth1, double depth2) {
    PlaneLayers all;
    all.layers = {{depth1, first, kEven}, {depth2, second, kEven}}, all.spaceRadiance = 1.0 / kPi;
    return all;
  };
  const std::vector<double> of8a{3.18310e-1, 3.18310e-1, 5.62566e-2, 1.94423e-2, 2.62711e-1, 1.36952e-1, 1.84909e-2, 5.52188e-3, 2.10014e-1, 5.60376e-2, 0, 0};
  const std::vector<double> of8b{3.18310e-1, 3.18310e-1, 1.23687e-1, 4.95581e-2, 2.77499e-1, 1.83950e-1, 8.35695e-2, 2.50575e-2, 2.40731e-1, 1.29291e-1, 0, 0};
  const std::vector<double> of8c{3.18310e-1, 3.18310e-1, 1.49335e-1, 1.04766e-1, 1.89020e-1, 9.88158e-2, 9.65192e-2, 6.54445e-2, 6.84762e-2, 2.96698e-2, 0, 0};
  std::vector<PrintedRun> cases{{"8a",
                                 two(0.5, 0.3, 0.25, 0.25),
                                 streams,
                                 {0, 1, 2},
                                 ways,
                                 {60.0},
                                 {1.0, 7.22235e-1, 5.13132e-1},
                                 {9.29633e-2, 2.78952e-2, 0},
                                 {1.12474, 6.51821e-1, 5.63361e-1},
                                 of8a},
                                {"8b",
                                 two(0.8, 0.95, 0.25, 0.25),
                                 streams,
                                 {0, 1, 2},
                                 ways,
                                 {60.0},
                                 {1.0, 7.95332e-1, 6.50417e-1},
                                 {2.25136e-1, 1.26349e-1, 0},
                                 {5.12692e-1, 3.56655e-1, 5.68095e-2},
                                 of8b},
                                {"8c",
                                 two(0.8, 0.95, 1.0, 2.0),
                                 streams,
                                 {0, 1, 2},
                                 ways,
                                 {60.0},
                                 {1.0, 4.86157e-1, 1.59984e-1},
                                 {3.78578e-1, 2.43397e-1, 0},
                                 {5.65095e-1, 2.76697e-1, 1.35679e-2},
                                 of8c}};
  // Six layers of depths 1 to 6, looked at from between at 1.05 and 2.1, too.
  const std::vector<double> devaux{1.0,          2.00916 / 3.0,  1.56339 / 5.0,  0.67407 / 7.0, 0.22215 / 9.0,
                                   0.04725 / 11, 0.00671 / 13.0, 0.00068 / 15.0, 0.00005 / 17.0};
  const std::vector<std::pair<int, double>> parts{{1, 1.0}, {2, 0.05}, {2, 1.05}, {2, 0.9}, {3, 3.0}, {4, 4.0}, {5, 5.0}, {6, 6.0}};
  const auto six = [&](const char which) {
    PlaneLayers all;
    double inside = 0.0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const auto [layer, depth] = parts[k];
      const double n = layer;
      if (k > 0 && layer != parts[k - 1].first) inside = 0.0;
      all.layers.push_back({depth, 0.6 + 0.05 * n, which == 'a' ? kEven : which == 'b' ? devaux : peaked(n / 7.0, 8)});
      if (which == 'c') {
        const double top = blackBetween(590 + 10 * n, 999, 1000), bottom = blackBetween(600 + 10 * n, 999, 1000);
        all.layers.back().blackAbove = top + (bottom - top) * inside / n, all.layers.back().blackBelow = top + (bottom - top) * (inside + depth) / n;
      }
      inside += depth;
    }
    all.spaceRadiance = 1.0 / kPi;
    if (which == 'c') {
      all.sunSine = 0.5, all.irradiance = kPi, all.spaceRadiance = 1.0 + blackBetween(550, 999, 1000);
      all.groundAlbedo = 0.5, all.groundEmission = 0.5 * blackBetween(700, 999, 1000);
    }
    return all;
  };
  const std::vector<double> of9a{3.18310e-1, 3.18310e-1, 9.98915e-2, 5.91345e-2, 1.53507e-1, 5.09531e-2, 3.67006e-2, 2.31903e-2, 7.06614e-2, 2.09119e-2,
                                 1.48545e-2, 9.72307e-3, 3.72784e-3, 1.08815e-3, 8.83316e-4, 5.94743e-4, 2.87656e-7, 1.05921e-7, 0,          0};
  cases.push_back({"9a",
                   six('a'),
                   streams,
                   {0, 2, 3, 5, 8},
                   ways,
                   {60.0},
                   {1.0, 3.55151e-1, 1.44265e-1, 6.71445e-3, 6.16968e-7},
                   {2.27973e-1, 8.75098e-2, 3.61819e-2, 2.19291e-3, 0},
                   {8.82116e-1, 2.32366e-1, 9.33443e-2, 3.92782e-3, 1.02500e-7},
                   of9a});
  const std::vector<double> of9b{3.18310e-1, 3.18310e-1, 7.39198e-2, 1.32768e-2, 1.96609e-1, 5.92369e-2, 3.00230e-2, 7.05566e-3, 1.15478e-1, 3.01809e-2,
                                 1.52672e-2, 4.06932e-3, 1.46177e-2, 3.85590e-3, 2.38301e-3, 7.77890e-4, 3.37742e-5, 1.20858e-5, 0,          0};
  cases.push_back({"9b",
                   six('b'),
                   streams,
                   {0, 2, 3, 5, 8},
                   ways,
                   {60.0},
                   {1.0, 4.52357e-1, 2.36473e-1, 2.76475e-2, 7.41853e-5},
                   {1.00079e-1, 4.52014e-2, 2.41941e-2, 4.16016e-3, 0},
                   {8.04577e-1, 2.55330e-1, 1.30976e-1, 1.36227e-2, 1.22022e-5},
                   of9b});
  const std::vector<double> of9c{1.93920, 1.93920, 1.61855, 1.43872, 1.66764, 1.44453, 1.38339, 1.33890, 1.48511, 1.35009, 1.33079, 1.32794,
                                 1.34514, 1.35131, 1.35980, 1.37918, 1.48927, 1.54270, 1.62823, 1.62823, 1.93920, 1.93920, 1.57895, 1.43872,
                                 1.66764, 1.42925, 1.37317, 1.33890, 1.48511, 1.34587, 1.32921, 1.32794, 1.34514, 1.35129, 1.35979, 1.37918,
                                 1.48927, 1.54270, 1.62823, 1.62823, 1.93920, 1.93920, 1.56559, 1.43872, 1.66764, 1.42444, 1.37034, 1.33890,
                                 1.48511, 1.34469, 1.32873, 1.32794, 1.34514, 1.35128, 1.35979, 1.37918, 1.48927, 1.54270, 1.62823, 1.62823};
  cases.push_back({"9c",
                   six('c'),
                   streams,
                   {0, 2, 3, 5, 8},
                   ways,
                   {60.0, 120.0, 180.0},
                   {6.09217, 4.97279, 4.46616, 4.22731, 4.73767},
                   {4.68414, 4.24381, 4.16941, 4.30667, 5.11524},
                   {3.49563, 8.81206e-1, 3.50053e-1, 1.93471e-2, 7.15349e-2},
                   of9c});
  expectPrintedDigits(cases, "DISORT 8 and 9, layers that differ");
}

// Source: van de Hulst 1980, Multiple Light Scattering, table 12 (pages 258 to 261, even scattering) and 35 (pages 419 and 431, Henyey and Greenstein's), five
// decimals: reflection and transmission functions R, T = pi I / (sine of the sun x its irradiance); of a sun overhead, irradiance that comes out, and half the
// scalar irradiance. As quoted by the tests of Mitsuba's layer module (albedo 0.8, depth 2) and of Flick-RT (depth 1).
TEST(PublishedTables, SlabsAreVanDeHulsts) {
  using namespace published;
  double worst = 0.0;
  const auto expect = [&](double found, double printed, const char* what, double of) {
    worst = std::max(worst, std::abs(found - printed));
    EXPECT_NEAR(found, printed, 1e-5) << what << " " << of;
  };
  const Streams streams{64, 1, 0.005, {0.5}};
  const std::vector<double> suns{1.0, 0.9, 0.7, 0.5, 0.3, 0.1}, back{0.28616, 0.30277, 0.34188, 0.39102, 0.45353, 0.53214},
      through{0.14864, 0.14731, 0.13963, NAN, 0.09425, 0.06601};
  for (std::size_t k = 0; k < suns.size(); ++k) {
    const LayerLight light = lightIn(sunlit({{2.0, 0.8, kEven}}, suns[k], kPi / suns[k]), streams);
    expect(radianceAt(light, 0, 0.5, 0.0), back[k], "R", suns[k]);
    if (std::isfinite(through[k])) expect(radianceAt(light, 1, -0.5, 0.0), through[k], "T", suns[k]);
  }
  const auto overhead = [&](double albedo, double g) { return lightIn(sunlit({{1.0, albedo, peaked(g, 80)}}, 1.0, 1.0), streams); };
  const LayerLight even = overhead(1.0, 0.0);
  expect(even.fluxUp[0], 0.34133, "irradiance upwards", 0.0);
  expect(even.fluxDown[1] + std::exp(-1.0), 0.65867, "irradiance downwards", 0.0);
  expect(0.5 * even.solarAt(0)[0], 0.37869, "half the scalar irradiance", 0.0);
  expect(overhead(1.0, 0.5).fluxDown[1] + std::exp(-1.0), 0.82389, "irradiance downwards", 0.5);
  expect(overhead(0.9, 0.5).fluxDown[1] + std::exp(-1.0), 0.73909, "irradiance downwards", 0.5);
  expect(overhead(0.9, 0.75).fluxDown[1] + std::exp(-1.0), 0.82792, "irradiance downwards", 0.75);
  test::bound("slabs against van de Hulst's tables 12 and 35", worst, 1e-5, "five decimals");
}

// Source: Chandrasekhar 1960, Radiative Transfer, table XI, page 125: H of albedo 0.1 and 1, sines 0.05, 0.1 to 1; for others H in closed form: Stibbs and Weir
// 1959, Mon. Not. R. Astron. Soc. 119, 512. What a half-space sends back: w F / (4 pi) s0 / (s + s0) H(s) H(s0).
TEST(PublishedTables, HalfSpacesAreChandrasekhars) {
  using namespace published;
  const std::vector<double> tenth{1.00783, 1.01238, 1.01584, 1.01864, 1.02099, 1.02300, 1.02475, 1.02630, 1.02768, 1.02892,
                                  1.03004, 1.03106, 1.03199, 1.03284, 1.03363, 1.03436, 1.03504, 1.03567, 1.03626, 1.03682},
      whole{1.1368, 1.2474, 1.3508, 1.4503, 1.5473, 1.6425, 1.7364, 1.8293, 1.9213, 2.0128,
            2.1037, 2.1941, 2.2842, 2.3740, 2.4635, 2.5527, 2.6417, 2.7306, 2.8193, 2.9078};
  const auto closed = [](double w, double s) {
    double sum = 0.0;
    // Towards both ends ever finer.
    for (const QuadratureNode& n : gaussLegendre(120, 0.0, 1.0)) {
      const auto smooth = [](double u) { return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u); };
      const auto slope = [](double u) { return 30.0 * u * u * (1.0 - u) * (1.0 - u); };
      const double v = smooth(n.x), t = 0.5 * kPi * smooth(v);
      const double left = t < 1e-3 ? 1.0 - w + w * t * t / 3.0 : 1.0 - w * t / std::tan(t);
      if (left > 0.0) sum += n.weight * slope(n.x) * slope(v) * 0.5 * kPi * std::log(left) / (std::pow(std::cos(t), 2) + std::pow(s * std::sin(t), 2));
    }
    return std::exp(-s / kPi * sum);
  };
  std::vector<double> sines;
  for (int k = 1; k <= 20; ++k) sines.push_back(0.05 * k);
  double ofTable = 0.0, ofClosed = 0.0, between = 0.0;
  // At 0.05 the table is 2 units off: 1.00783 and 1.1368 for 1.007809 and 1.136575.
  for (std::size_t k = 1; k < sines.size(); ++k) {
    between = std::max(between, std::abs(closed(0.1, sines[k]) - tenth[k]) / 1e-5);
    between = std::max(between, std::abs(closed(1.0, sines[k]) - whole[k]) / 1e-4);
  }
  test::bound("H in closed form against table XI, in units of its last digit", between, 1.0, "Chandrasekhar 1960");
  for (const double w : {0.1, 0.5, 0.9, 1.0})
    for (const std::size_t sun : {1u, 9u, 19u}) {
      const LayerLight light = lightIn(sunlit({{w < 1.0 ? 1e3 : 1e6, w, kEven}}, sines[sun], 4.0 * kPi / w), {64, 1, 0.005, sines});
      for (std::size_t k = 1; k < sines.size(); ++k) {
        const double found = radianceAt(light, 0, sines[k], 0.0) * (sines[k] + sines[sun]) / sines[sun];
        const double exact = closed(w, sines[k]) * closed(w, sines[sun]);
        ofClosed = std::max(ofClosed, std::abs(found / exact - 1.0));
        EXPECT_NEAR(found / exact, 1.0, 1e-5) << w << " " << sines[k] << " " << sines[sun];
        if (w == 0.1) ofTable = std::max(ofTable, std::abs(found - tenth[k] * tenth[sun]) / 2e-5);
        if (w == 1.0) ofTable = std::max(ofTable, std::abs(found - whole[k] * whole[sun]) / (1e-4 * (whole[k] + whole[sun])));
      }
    }
  test::bound("half-spaces against table XI, in units of its last digit", ofTable, 1.0, "Chandrasekhar 1960; sines from 0.1 on");
  test::bound("half-spaces against H in closed form", ofClosed, 1e-5, "Stibbs and Weir 1959; 64 streams, sines from 0.1 on");
}

// Source: Natraj, Li and Yung 2009, Astrophys. J. 691, 1909: I of light with polarisation, eight decimals, sunlight pi on a plane facing it; their tables
// I_UP_TAU_* and I_DN_TAU_*, of ground albedo 0 unless said otherwise.
// What is published of light without polarisation: "can be larger than 10 %"; 8 % of a clear sky at 0.4 um, across from the sun (Emde and Mayer 2018, arXiv
// 1901.01836, abstract). The bounds here are what is found, rounded up: no solver without polarisation is better, see the next test.
TEST(PublishedTables, LightWithoutPolarisationIsNearNatrajs) {
  using namespace published;
  struct Row {
    double sun, sine;
    double up[3], down[3];  ///< at azimuths 0, 90 and 180 degrees from the sun's own way
  };
  const std::vector<std::pair<double, std::vector<Row>>> tables{{0.02,
                                                                 {{0.2, 0.1, {0.06507191, 0.03487511, 0.06769366}, {0.06747768, 0.03476602, 0.06486438}},
                                                                  {0.2, 0.4, {0.01526960, 0.00938358, 0.01786547}, {0.01785118, 0.00937620, 0.01525741}},
                                                                  {0.2, 1.0, {0.00383479, 0.00383479, 0.00383479}, {0.00383356, 0.00383356, 0.00383356}},
                                                                  {0.6, 0.1, {0.05412668, 0.03575623, 0.06075671}, {0.06069194, 0.03571860, 0.05406903}},
                                                                  {0.6, 0.4, {0.01175359, 0.01009007, 0.01832346}, {0.01831857, 0.01008740, 0.01175046}},
                                                                  {0.6, 1.0, {0.00517306, 0.00517306, 0.00517306}, {0.00517250, 0.00517250, 0.00517250}},
                                                                  {1.0, 0.1, {0.03548328, 0.03548328, 0.03548328}, {0.03546051, 0.03546051, 0.03546051}},
                                                                  {1.0, 0.4, {0.01095104, 0.01095104, 0.01095104}, {0.01094928, 0.01094928, 0.01094928}},
                                                                  {1.0, 1.0, {0.00764380, 0.00764380, 0.00764380}, {0.00764331, 0.00764331, 0.00764331}}}},
                                                                {0.1,
                                                                 {{0.2, 0.1, {0.22015910, 0.12407878, 0.22874840}, {0.21301331, 0.11599179, 0.20503467}},
                                                                  {0.2, 0.4, {0.06563962, 0.04204534, 0.07641987}, {0.07504711, 0.04132600, 0.06446675}},
                                                                  {0.2, 1.0, {0.01720538, 0.01720538, 0.01720538}, {0.01708067, 0.01708067, 0.01708067}},
                                                                  {0.6, 0.1, {0.20280116, 0.13841994, 0.22684018}, {0.22148582, 0.13527542, 0.19803257}},
                                                                  {0.6, 0.4, {0.05706243, 0.04994781, 0.08778124}, {0.08724766, 0.04965460, 0.05672060}},
                                                                  {0.6, 1.0, {0.02602413, 0.02602413, 0.02602413}, {0.02596029, 0.02596029, 0.02596029}},
                                                                  {1.0, 0.1, {0.13482764, 0.13482764, 0.13482764}, {0.13290563, 0.13290563, 0.13290563}},
                                                                  {1.0, 0.4, {0.05362324, 0.05362324, 0.05362324}, {0.05342717, 0.05342717, 0.05342717}},
                                                                  {1.0, 1.0, {0.03912557, 0.03912557, 0.03912557}, {0.03906738, 0.03906738, 0.03906738}}}},
                                                                {0.5,
                                                                 {{0.2, 0.1, {0.35082997, 0.21348201, 0.36354469}, {0.13485741, 0.08801144, 0.13070302}},
                                                                  {0.2, 0.4, {0.16889020, 0.11786073, 0.19363900}, {0.14070011, 0.08842135, 0.12339910}},
                                                                  {0.2, 1.0, {0.05300496, 0.05300496, 0.05300496}, {0.04682203, 0.04682203, 0.04682203}},
                                                                  {0.6, 0.1, {0.40092320, 0.29266545, 0.44351753}, {0.31229785, 0.21210243, 0.28360956}},
                                                                  {0.6, 0.4, {0.21823530, 0.19873194, 0.31935862}, {0.28443395, 0.17874735, 0.19553425}},
                                                                  {0.6, 1.0, {0.11794949, 0.11794949, 0.11794949}, {0.11256639, 0.11256639, 0.11256639}},
                                                                  {1.0, 0.1, {0.28659837, 0.28659837, 0.28659837}, {0.23412702, 0.23412702, 0.23412702}},
                                                                  {1.0, 0.4, {0.21983662, 0.21983662, 0.21983662}, {0.20549731, 0.20549731, 0.20549731}},
                                                                  {1.0, 1.0, {0.18863438, 0.18863438, 0.18863438}, {0.18312638, 0.18312638, 0.18312638}}}},
                                                                {1.0,
                                                                 {{0.2, 0.1, {0.36980528, 0.22978197, 0.38279525}, {0.05824896, 0.04383194, 0.05700364}},
                                                                  {0.2, 0.4, {0.20077492, 0.14519439, 0.22797990}, {0.09729223, 0.06870206, 0.08772147}},
                                                                  {0.2, 1.0, {0.07282389, 0.07282389, 0.07282389}, {0.05274036, 0.05274036, 0.05274036}},
                                                                  {0.6, 0.1, {0.46679207, 0.35117264, 0.51253314}, {0.23512706, 0.17437234, 0.21766614}},
                                                                  {0.6, 0.4, {0.32153449, 0.29780317, 0.45082643}, {0.31507557, 0.21684582, 0.23152721}},
                                                                  {0.6, 1.0, {0.20216409, 0.20216409, 0.20216409}, {0.17468376, 0.17468376, 0.17468376}},
                                                                  {1.0, 0.1, {0.36135319, 0.36135319, 0.36135319}, {0.23500677, 0.23500677, 0.23500677}},
                                                                  {1.0, 0.4, {0.35024888, 0.35024888, 0.35024888}, {0.28650868, 0.28650868, 0.28650868}},
                                                                  {1.0, 1.0, {0.33854762, 0.33854762, 0.33854762}, {0.30690689, 0.30690689, 0.30690689}}}}};
  const auto lit = [](double depth, double sun, double ground) {
    PlaneLayers all = sunlit({{depth, 1.0, kMolecules}}, sun, kPi);
    all.groundAlbedo = ground;
    return lightIn(all, {32, 3, 0.005, {0.1, 0.4, 1.0}});
  };
  double back = 0.0, through = 0.0;
  for (const auto& [depth, rows] : tables) {
    double up = 0.0, down = 0.0, squares = 0.0;
    for (const Row& r : rows) {
      const LayerLight light = lit(depth, r.sun, 0.0);
      for (int k = 0; k < 3; ++k) {
        const double offUp = radianceAt(light, 0, r.sine, 0.5 * kPi * k) / r.up[k] - 1.0,
                     offDown = radianceAt(light, 1, -r.sine, 0.5 * kPi * k) / r.down[k] - 1.0;
        up = std::max(up, std::abs(offUp)), down = std::max(down, std::abs(offDown)), squares += offUp * offUp + offDown * offDown;
      }
    }
    std::printf("molecules of depth %.2f: without polarisation, light sent back is off by %.1f %% at most, let through by %.1f %%; rms %.1f %%\n", depth,
                100.0 * up, 100.0 * down, 100.0 * std::sqrt(squares / (6.0 * static_cast<double>(rows.size()))));
    EXPECT_GT(up, back) << "polarisation counts from the second turn on: more with depth, up to 1";
    EXPECT_GT(down, through);
    back = up, through = down;
  }
  test::bound("what light sent back by molecules to depth 1 is off for want of polarisation", back, 0.12, "Natraj, Li and Yung 2009");
  test::bound("what light let through by molecules to depth 1 is off for want of polarisation", through, 0.18, "the same; low sun, near the horizon");
  // Light that the ground sends out is not polarised, and irradiance hardly knows.
  struct Ground {
    double sun, sine, albedo, bright, dark;
  };
  double worst = 0.0;
  for (const Ground& g : {Ground{0.2, 0.4, 0.8, 0.23059806, 0.16889020}, {0.2, 1.0, 0.8, 0.13280858, 0.05300496}, {0.4, 0.4, 0.25, 0.25985732, 0.21874883}}) {
    const double found = radianceAt(lit(0.5, g.sun, g.albedo), 0, g.sine, 0.0) - radianceAt(lit(0.5, g.sun, 0.0), 0, g.sine, 0.0);
    worst = std::max(worst, std::abs(found / (g.bright - g.dark) - 1.0));
  }
  test::bound("what an even ground adds under molecules of depth 0.5", worst, 2e-3, "Natraj, Li and Yung 2009; polarisation");
}

// The same by orders of scattering, for a sun overhead: there is no azimuth then, and light has two components, along and across the plane of sight. With
// polarisation it is Natraj's table, without it the solver's light, each to five digits: the deviations above are polarisation's alone.
// Source: Chandrasekhar 1960, chapter I, section 17: 3/4 (2 (1 - s^2)(1 - p^2) + s^2 p^2, s^2; p^2, 1).
TEST(PublishedTables, PolarisationIsAllThatParts) {
  using namespace published;
  constexpr std::size_t kSteps = 400, kOrders = 40;
  const double depth = 1.0, step = depth / kSteps;
  std::vector<QuadratureNode> ways = gaussLegendre(12, 0.0, 1.0);
  const std::size_t streams = ways.size();
  for (double s : {0.1, 0.4, 1.0}) ways.push_back({s, 0.0});
  const std::size_t all = 2 * ways.size();
  using Field = std::vector<std::vector<double>>;
  const auto byOrders = [&](bool polarised, Field& up, Field& down) {
    const auto turned = [&](double s, double p, double along, double across) -> std::array<double, 2> {
      if (polarised) return {0.75 * ((2.0 * (1.0 - s * s) * (1.0 - p * p) + s * s * p * p) * along + s * s * across), 0.75 * (p * p * along + across)};
      const double half = 0.5 * (1.0 + 0.125 * (3.0 * s * s - 1.0) * (3.0 * p * p - 1.0)) * (along + across);
      return {half, half};
    };
    Field first(kSteps + 1, std::vector<double>(all));
    for (std::size_t i = 0; i <= kSteps; ++i)
      for (std::size_t j = 0; j < ways.size(); ++j) {
        const double sun = 0.125 * std::exp(-static_cast<double>(i) * step);
        const auto [along, across] = turned(ways[j].x, 1.0, sun, sun);
        first[i][2 * j] = along, first[i][2 * j + 1] = across;
      }
    Field source = first;
    up.assign(kSteps + 1, std::vector<double>(all)), down = up;
    for (std::size_t order = 0; order < kOrders; ++order) {
      // Sources linear in depth between the steps.
      for (std::size_t c = 0; c < all; ++c) {
        const double h = step / ways[c / 2].x, left = std::exp(-h), mean = -std::expm1(-h) / h;
        for (std::size_t i = 0; i < kSteps; ++i) {
          down[i + 1][c] = down[i][c] * left + source[i + 1][c] * (1.0 - mean) + source[i][c] * (mean - left);
          const std::size_t k = kSteps - i;
          up[k - 1][c] = up[k][c] * left + source[k - 1][c] * (1.0 - mean) + source[k][c] * (mean - left);
        }
      }
      for (std::size_t i = 0; i <= kSteps; ++i) {
        source[i] = first[i];
        for (std::size_t j = 0; j < ways.size(); ++j)
          for (std::size_t p = 0; p < streams; ++p) {
            const auto [along, across] = turned(ways[j].x, ways[p].x, up[i][2 * p] + down[i][2 * p], up[i][2 * p + 1] + down[i][2 * p + 1]);
            source[i][2 * j] += 0.5 * ways[p].weight * along, source[i][2 * j + 1] += 0.5 * ways[p].weight * across;
          }
      }
    }
  };
  Field up, down;
  const std::vector<double> tableUp{0.36135319, 0.35024888, 0.33854762}, tableDown{0.23500677, 0.28650868, 0.30690689};  // depth 1, mu0 = 1
  const LayerLight light = lightIn(sunlit({{depth, 1.0, kMolecules}}, 1.0, kPi), {32, 1, 0.005, {0.1, 0.4, 1.0}});
  double ofTable = 0.0, ofSolver = 0.0;
  for (const bool polarised : {true, false}) {
    byOrders(polarised, up, down);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t c = 2 * (streams + k);
      const double s = ways[streams + k].x, above = polarised ? tableUp[k] : radianceAt(light, 0, s, 0.0),
                   below = polarised ? tableDown[k] : radianceAt(light, 1, -s, 0.0);
      double& worst = polarised ? ofTable : ofSolver;
      worst = std::max({worst, std::abs((up[0][c] + up[0][c + 1]) / above - 1.0), std::abs((down[kSteps][c] + down[kSteps][c + 1]) / below - 1.0)});
    }
  }
  test::bound("orders of scattering with polarisation against Natraj's tables, depth 1", ofTable, 2e-5, "sources linear within 1/400 of the depth");
  test::bound("orders of scattering without it against the solver, depth 1", ofSolver, 2e-5, "the same");
}

// Albedo 0 and 1, depths 1e-6 to 1e6 in one layer, the sun overhead, level and below, g up to 0.999.
TEST(PublishedTables, NothingIsTooThinOrTooDeep) {
  using namespace published;
  double lost = 0.0, gained = 0.0;
  for (const double albedo : {0.0, 0.5, 1.0 - 1e-12, 1.0})
    for (const double depth : {0.0, 1e-6, 1e-3, 1.0, 1e3, 1e6})
      for (const double g : {-0.999, 0.0, 0.999})
        for (const double sun : {1.0, 0.3, 1e-3, 1e-12, 0.0, -1e-12, -1e-3, -0.1})
          for (const double ground : {0.0, 1.0}) {
            PlaneLayers all = sunlit({{depth, albedo, peaked(g, 40), 1.0, 2.0}}, sun, 1.0);
            all.groundAlbedo = ground, all.spaceRadiance = 0.5, all.groundEmission = 1.0 - ground;
            // From below it shines as far as told.
            if (sun < 0.0) all.sunDepth = {depth + 1.0, INFINITY};
            const LayerLight light = lightIn(all, {8, 8, 0.005, {1e-3, 1.0}});
            for (const auto* values :
                 {&light.solar, &light.thermal, &light.solarUp, &light.solarDown, &light.thermalUp, &light.thermalDown, &light.fluxUp, &light.fluxDown})
              for (double v : *values) ASSERT_TRUE(std::isfinite(v)) << albedo << " " << depth << " " << g << " " << sun << " " << ground;
            for (std::size_t e : {0u, 1u}) ASSERT_TRUE(albedo > 0.0 || light.solarDown[e * 8 * light.sines.size()] == 0.0);
            if (albedo < 1.0 || sun < 0.0) continue;
            // What comes in goes out: at the top, or to the black ground.
            const double in = kPi * 0.5 + sun, through = ground > 0.0 ? 0.0 : light.fluxDown[1] + sun * std::exp(-depth / std::max(sun, 1e-9)) - kPi;
            double& worst = sun < 1e-6 ? gained : lost;
            worst = std::max(worst, std::abs(light.fluxUp[0] + through - in) / in);
          }
  test::bound("what one layer loses that absorbs nothing", lost, 1e-6, "depths 0 to 1e6, g from -0.999 to 0.999, sun from 0.06 to 90 degrees");
  // Depth to the sun ends at 1e9: a layer of 1e6 has light of a level sun as if it stood 1e-3 high.
  test::bound("what such a layer gains from a level sun", gained, 1e-3, "the same; of what comes in from space, 1.6 beside a sun of 1");
  // Without scattering, B within and nothing around: B (1 - e^(-t / s)).
  for (const double depth : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    PlaneLayers all;
    all.layers = {{depth, 0.0, kEven, 3.0, 3.0}};
    const LayerLight light = lightIn(all, {8, 1, 0.005, {0.3}});
    EXPECT_NEAR(radianceAt(light, 0, 0.3, 0.0) / (-3.0 * std::expm1(-depth / 0.3)), 1.0, 1e-8) << depth;
    EXPECT_NEAR(radianceAt(light, 1, -0.3, 0.0) / (-3.0 * std::expm1(-depth / 0.3)), 1.0, 1e-8) << depth;
  }
}

}  // namespace
}  // namespace pitviper
