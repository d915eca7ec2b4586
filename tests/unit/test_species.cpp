// Absorbers by species: the library's tables against the band model they stand for, closed forms and published figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "materials/fields/k_distribution.hpp"
#include "materials/fields/species.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

const fs::path& libraryFolder() {
  static const fs::path folder = fs::path(PITVIPER_SOURCE_DIR) / "materials/library";
  return folder;
}
const SpeciesTable& table(Species species) { return speciesTable(species, libraryFolder()); }

/// Emissivities of RADCAL by wavenumber, temperature and path (their averages over its own steps).
struct Row {
  double low_per_cm, high_per_cm;
  std::vector<double> emissivity;
};
constexpr double kTemperatures_K[] = {300, 500, 700, 850, 1000, 1200, 1500, 1800};
constexpr double kPaths_atm_m[] = {0.002, 0.01, 0.05, 0.2};

fs::path plumeData() {
  const char* named = std::getenv("PITVIPER_REFERENCE_DATA");
  return (named ? fs::path(named) : fs::path(PITVIPER_SOURCE_DIR) / "../shared/data") / "plume";
}

/// A row stands for what is nearer to it than to its neighbours.
std::vector<Row> radcal(const std::string& name) {
  std::vector<Row> rows;
  std::vector<double> centres;
  std::ifstream in(plumeData() / name);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || !std::isdigit(static_cast<unsigned char>(line[0]))) continue;
    std::istringstream cells(line);
    std::vector<double> values;
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
    centres.push_back(values[0]);
    rows.push_back({0, 0, {values.begin() + 2, values.end()}});
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double below = i > 0 ? centres[i - 1] : 2.0 * centres[0] - centres[1];
    const double above = i + 1 < rows.size() ? centres[i + 1] : 2.0 * centres[i] - centres[i - 1];
    rows[i].low_per_cm = 0.5 * (below + centres[i]);
    rows[i].high_per_cm = 0.5 * (centres[i] + above);
  }
  return rows;
}

/// RADCAL's steps below 1100 1/cm put together to the bands of our tables, which are wider there.
std::vector<Row> inBandsOf(const SpeciesTable& gas, const std::vector<Row>& rows) {
  std::vector<Row> together;
  for (const Row& row : rows) {
    const auto band = std::find_if(gas.bands.begin(), gas.bands.end(), [&](const SpeciesBand& b) {
      const double middle = 0.5 * (row.low_per_cm + row.high_per_cm);
      return middle > b.low_per_cm && middle < b.high_per_cm;
    });
    const bool joins = band != gas.bands.end() && !together.empty() && together.back().low_per_cm >= band->low_per_cm - 1e-9;
    if (!joins) {
      together.push_back(row);
      // RADCAL's figures begin within a band of ours.
      if (together.size() == 1 && band != gas.bands.end()) together.back().low_per_cm = band->low_per_cm;
      continue;
    }
    Row& whole = together.back();
    const double had = whole.high_per_cm - whole.low_per_cm, has = row.high_per_cm - row.low_per_cm;
    for (std::size_t i = 0; i < row.emissivity.size(); ++i) whole.emissivity[i] = (had * whole.emissivity[i] + has * row.emissivity[i]) / (had + has);
    whole.high_per_cm = row.high_per_cm;
  }
  return together;
}

/// Mean of a piecewise constant function between two wavenumbers, over wavelength.
template <class F>
double meanBetween(double low_per_cm, double high_per_cm, const F& f) {
  // The narrowest cell is a thirtieth of a band: 600 points see its edges within 5 % of it, all together within 0.1 %.
  constexpr int kPoints = 600;
  const double from_um = 1e4 / high_per_cm, to_um = 1e4 / low_per_cm;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) sum += f(from_um + (to_um - from_um) * (i + 0.5) / kPoints);
  return sum / kPoints;
}

/// Mean over the cells of a band, which all gases share.
template <class F>
double cellMean(const SpeciesBand& band, const F& f) {
  const auto shares = cellShares(band.cells);
  const double from_um = 1e4 / band.high_per_cm, to_um = 1e4 / band.low_per_cm;
  double below = 0.0, sum = 0.0;
  for (double share : shares) {
    sum += share * f(from_um + (below + 0.5 * share) * (to_um - from_um));
    below += share;
  }
  return sum;
}

double wavelengthOf(const Row& row) { return 2e4 / (row.low_per_cm + row.high_per_cm); }
double planckShare(const Row& row, double temperature_K) {
  return physics::planckRadiance(wavelengthOf(row), temperature_K) * (1e4 / row.low_per_cm - 1e4 / row.high_per_cm);
}

struct Gas {
  Species species;
  const char* file;
};
constexpr Gas kGases[] = {{Species::CO2, "hotgas_co2_emissivity.csv"}, {Species::H2O, "hotgas_h2o_emissivity.csv"}};

#define NEEDS_RADCAL(file) \
  if (!fs::exists(plumeData() / (file))) GTEST_SKIP() << "no " << plumeData() / (file) << "; the reference tables are no part of the project"

// Rationale: what ships are bands of two parameters and levels of temperature; what they were made from are emissivities of RADCAL. Expected: those, over
// all wavenumbers, temperatures and paths; and weighted with Planck's law over the bands of cameras, where errors of neighbours cancel.
TEST(Species, GasesEmitAsRadcal) {
  for (const Gas& gas : kGases) {
    NEEDS_RADCAL(gas.file);
    const SpeciesTable& own = table(gas.species);
    const auto rows = inBandsOf(own, radcal(gas.file));
    ASSERT_GT(rows.size(), 170u);
    double worst = 0.0, squares = 0.0;
    struct Window {
      double low_um, high_um, worst = 0.0;
    };
    std::vector<Window> windows{{2, 3}, {3, 5}, {3.6, 4.9}, {8, 12}};
    for (std::size_t t = 0; t < 8; ++t)
      for (std::size_t p = 0; p < 4; ++p) {
        std::vector<double> error(windows.size()), whole(windows.size());
        for (const Row& row : rows) {
          const double wanted = row.emissivity[4 * t + p];
          const double has = meanBetween(row.low_per_cm, row.high_per_cm,
                                         [&](double um) { return -std::expm1(-absorptionOf(own, um, kTemperatures_K[t]) * kPaths_atm_m[p]); });
          worst = std::max(worst, std::abs(has - wanted));
          squares += (has - wanted) * (has - wanted);
          for (std::size_t w = 0; w < windows.size(); ++w)
            if (wavelengthOf(row) > windows[w].low_um && wavelengthOf(row) < windows[w].high_um) {
              error[w] += planckShare(row, kTemperatures_K[t]) * (has - wanted);
              whole[w] += planckShare(row, kTemperatures_K[t]);
            }
        }
        for (std::size_t w = 0; w < windows.size(); ++w) windows[w].worst = std::max(windows[w].worst, std::abs(error[w] / whole[w]));
      }
    bound(own.name + " against RADCAL, emissivity of single bands, worst of 32 columns", worst, 0.013,
          "fit of the 15 um Q branch in 25 1/cm 0.007; steps for a band 0.005");
    bound(own.name + ", the same, rms", std::sqrt(squares / static_cast<double>(rows.size() * 32)), 0.001, "steps for a band");
    for (const Window& w : windows) {
      char what[96];
      std::snprintf(what, sizeof what, "%s, Planck mean of emissivity, %.2g-%.2g um, worst of 32 columns", own.name.c_str(), w.low_um, w.high_um);
      bound(what, w.worst, 0.002, "half of the steps' 0.004: signs alternate over x");
    }
  }
}

// A mixture that the tables were not made from: 11 % of each gas, 1 m, 1800 K. There water broadens its own lines by a fifth more than the 5 % of the tables do
// (0.44 1/cm per atm of it at 273 K, NASA SP-3080), which raises emissivities that grow with the root of the width by up to 0.02.
constexpr const char* kBroader = "RADCAL; water's lines are a fifth broader there, the product of two gases' steps";
TEST(Species, AMixtureEmitsAsRadcal) {
  NEEDS_RADCAL("plume_afterburner_1800K_slab.csv");
  const SpeciesTable &co2 = table(Species::CO2), &h2o = table(Species::H2O);
  const auto rows = inBandsOf(h2o, radcal("plume_afterburner_1800K_slab.csv"));
  const auto has = [&](const Row& row) {
    return meanBetween(row.low_per_cm, row.high_per_cm,
                       [&](double um) { return -std::expm1(-0.11 * (absorptionOf(co2, um, 1800.0) + absorptionOf(h2o, um, 1800.0))); });
  };
  double worst = 0.0;
  for (const Row& row : rows) worst = std::max(worst, std::abs(has(row) - row.emissivity[0]));
  bound("11 % CO2 and H2O, 1 m, 1800 K, emissivity of single bands, worst", worst, 0.03, kBroader);
  for (const auto& [low, high] : {std::pair{2.0, 3.0}, {3.0, 5.0}, {3.6, 4.9}, {8.0, 12.0}}) {
    double ours = 0.0, theirs = 0.0, weights = 0.0;
    for (const Row& row : rows)
      if (wavelengthOf(row) > low && wavelengthOf(row) < high) {
        ours += planckShare(row, 1800.0) * has(row);
        theirs += planckShare(row, 1800.0) * row.emissivity[0];
        weights += planckShare(row, 1800.0);
      }
    char what[96];
    std::snprintf(what, sizeof what, "11 %% CO2 and H2O, 1 m, 1800 K, Planck mean of emissivity, %.2g-%.2g um", low, high);
    figure(what, ours / weights, theirs / weights, 0.015, kBroader);
  }
}

// Rationale: a band is laid out in few steps. Expected: the curve of growth it stands for, at any path.
TEST(KDistribution, StepsGrowAsTheirCurve) {
  struct Case {
    std::size_t cells;
    BandAbsorber gas;
    double leastOverlap, most;
    const char* what;
  };
  for (const Case& c :
       {Case{6, BandAbsorber::WaterVapour, 0.01, 0.004, "6 steps, water vapour"}, Case{8, BandAbsorber::CarbonDioxide, 0.03, 0.005, "8 steps, carbon dioxide"},
        Case{8, BandAbsorber::WaterVapour, 0.01, 0.005, "8 steps, water vapour"},
        Case{12, BandAbsorber::CarbonDioxide, 0.01, 0.005, "12 steps, carbon dioxide"},
        Case{12, BandAbsorber::WaterVapour, 0.01, 0.004, "12 steps, water vapour"},
        Case{12, BandAbsorber::CarbonMonoxide, 0.01, 0.005, "12 steps, carbon monoxide"}}) {
    double worst = 0.0;
    for (double overlap = c.leastOverlap; overlap < 120.0; overlap *= 1.07) {
      const auto levels = cellAbsorption(c.cells, c.gas, overlap);
      const auto shares = cellShares(c.cells);
      const auto order = cellOfRank(c.cells, c.gas);
      double mean = 0.0;
      for (std::size_t i = 0; i < c.cells; ++i) mean += shares[i] * levels[i];
      ASSERT_NEAR(mean, 1.0, 1e-12);  // thin gas is exact; rounding
      for (std::size_t i = 1; i < c.cells; ++i) ASSERT_GE(levels[order[i]], levels[order[i - 1]]) << c.what << ", overlap " << overlap;
      for (double x = 1e-4; x < 1e5; x *= 1.2) {
        double passed = 0.0;
        for (std::size_t i = 0; i < c.cells; ++i) passed += shares[i] * std::exp(-levels[i] * x);
        worst = std::max(worst, std::abs(passed - std::exp(-curveOfGrowth(1.0, std::min(overlap, 100.0), x))));
      }
    }
    bound(std::string(c.what) + ", transmittance, worst over paths and overlaps", worst, c.most, "a cubic of the normal deviate and this many steps");
  }
  EXPECT_THROW(cellShares(7), std::invalid_argument);
}

// The same for all bands and levels of the tables, from 0.001 to 5 atm m.
TEST(KDistribution, TablesGrowAsTheirBands) {
  for (Species species : {Species::CO2, Species::H2O, Species::CO}) {
    const SpeciesTable& gas = table(species);
    double worst = 0.0;
    for (const SpeciesBand& band : gas.bands)
      for (std::size_t l = 0; l < gas.temperature_K.size(); ++l)
        for (double path = 0.001; path < 5.01; path *= 1.5) {
          const double passed = cellMean(band, [&](double um) { return um < 30.0 ? std::exp(-gas.absorption[l](um) * path) : 1.0; });
          if (1e4 / band.low_per_cm < 30.0) worst = std::max(worst, std::abs(passed - std::exp(-curveOfGrowth(band.mean_per_atm_m[l], band.overlap[l], path))));
        }
    bound(gas.name + ", steps against curves of growth, 0.001 to 5 atm m, all bands and levels", worst, 0.008,
          "the same; a little more for the few bands of overlaps below 0.01");
  }
}

/// Malkmus' band and its k-distribution in closed form, with the mean as unit: G. A. Domoto's inverse (JQSRT 14, 935 (1974)); statisticians' inverse
/// Gaussian distribution. `shape` is pi/2 of Malkmus' line parameter B.
double malkmus(double shape, double x) { return std::exp(-shape * (std::sqrt(1.0 + 2.0 * x / shape) - 1.0)); }
double malkmusDensity(double shape, double k) { return std::sqrt(shape / (2.0 * kPi * k * k * k)) * std::exp(-0.5 * shape * (k - 1.0) * (k - 1.0) / k); }
double malkmusBelow(double shape, double k) {
  const auto normal = [](double z) { return 0.5 * std::erfc(-z * std::sqrt(0.5)); };
  const double root = std::sqrt(shape / k);
  return normal(root * (k - 1.0)) + std::exp(2.0 * shape) * normal(-root * (k + 1.0));
}

// Rationale: the fit of levels knows a transmittance only. Expected: levels of the k-distribution itself where that is known in closed form: each step's level
// lies between the quantiles of its step's edges.
TEST(KDistribution, FitFindsMalkmusClosedForm) {
  for (double shape : {0.2, 1.0, 5.0}) {
    // The closed form first: its Laplace transform and its integral, over log k.
    for (double x : {0.03, 1.0, 30.0}) {
      double transform = 0.0, below = 0.0;
      constexpr double kStep = 0.002;
      for (double u = -18.0; u < 18.0; u += kStep) {
        const double k = std::exp(u), weight = malkmusDensity(shape, k) * k * kStep;
        transform += weight * std::exp(-k * x);
        if (k < 1.0) below += weight;
      }
      EXPECT_NEAR(transform, malkmus(shape, x), 1e-6) << shape << " " << x;  // the rule's step
      EXPECT_NEAR(below, malkmusBelow(shape, 1.0), 2e-3);                    // one step at the edge
    }
    const auto shares = cellShares(12);
    const std::vector<double> weights(shares.begin(), shares.end());
    const RankCurve curve = fitRankCurve([&](double x) { return malkmus(shape, x); }, weights, {0.0, 1.0, 0.0, 0.0});
    const auto levels = levelsOf(curve, weights);
    double passedWorst = 0.0, share = 0.0, offWorst = 0.0;
    for (double x = 1e-3; x < 1e4; x *= 1.3) {
      double passed = 0.0;
      for (std::size_t i = 0; i < 12; ++i) passed += weights[i] * std::exp(-levels[i] * x);
      passedWorst = std::max(passedWorst, std::abs(passed - malkmus(shape, x)));
    }
    for (std::size_t i = 0; i < 12; ++i) {
      const double at = malkmusBelow(shape, levels[i]);
      offWorst = std::max({offWorst, share - at, at - share - weights[i]});
      share += weights[i];
    }
    char what[80];
    std::snprintf(what, sizeof what, "Malkmus' band, shape %.2g, 12 fitted steps, transmittance", shape);
    bound(what, passedWorst, 0.003, "as for Goody's band");
    bound(std::string(what) + ", share by which a level leaves its step", offWorst, 0.002, "closed form");
  }
}

// Strength of the fundamental: 237 1/(cm2 atm) at 300 K (Penner and Weber 1951; Pugh and Rao, Molecular Spectroscopy: Modern Research II (1976)), per
// molecule nearly the same at all temperatures.
TEST(Species, CarbonMonoxideHasItsStrength) {
  const SpeciesTable& co = table(Species::CO);
  for (std::size_t l = 0; l < co.temperature_K.size(); ++l) {
    const double t = co.temperature_K[l];
    double strength = 0.0;  // 1/(m atm) x 1/cm, at the gas's density
    for (const SpeciesBand& band : co.bands) strength += band.mean_per_atm_m[l] * (band.high_per_cm - band.low_per_cm);
    if (t > 2000.0) continue;  // the band reaches out of its 1600 to 2400 1/cm
    figure("carbon monoxide, strength at " + std::to_string(static_cast<int>(t)) + " K, as at 300 K [1/(cm2 atm)]", 0.01 * strength * t / 300.0, 237.0, 0.03,
           "Pugh and Rao; the fit of bands whose means are curves of growth");
  }
  // The maxima of its P and R branch at 300 K: rotational lines of J = 7 beside 2143 1/cm.
  const auto strongest = std::max_element(co.bands.begin(), co.bands.end(), [](auto& a, auto& b) { return a.mean_per_atm_m[0] < b.mean_per_atm_m[0]; });
  EXPECT_NEAR(0.5 * (strongest->low_per_cm + strongest->high_per_cm), 2143.0 + 30.0, 15.0);
}

// Published: mass absorption of flame soot; E(m) from 0.26 to 0.4 at visible wavelengths, k wavelength / volume fraction from 3.7 to 7.5 (J. Dalzell, A.
// Sarofim 1969; C. Shaddix, K. Smyth 1996; RADCAL's 8.9 after J. Widmann and G. Mulholland with agglomerates).
TEST(Species, SootAbsorbsAsPublished) {
  const SpeciesTable& soot = table(Species::Soot);
  for (double um : {0.4, 0.633, 1.06, 4.0, 10.0}) {
    const double n = 1.811 + 0.1263 * std::log(um) + 0.027 * std::pow(std::log(um), 2) + 0.0417 * std::pow(std::log(um), 3);
    const double k = 0.5821 + 0.1213 * std::log(um) + 0.2309 * std::pow(std::log(um), 2) - 0.01 * std::pow(std::log(um), 3);
    const double closed = 36.0 * kPi * n * k / (std::pow(n * n - k * k + 2.0, 2) + 4.0 * n * n * k * k);
    figure("soot, absorption x wavelength / volume fraction at " + std::to_string(um).substr(0, 5) + " um", absorptionOf(soot, um, 1200.0) * um * 1e-6, closed,
           0.003, "Chang and Charalampopoulos (1990); linear between 83 rows");
    EXPECT_GT(closed, 3.7);
    EXPECT_LT(closed, 8.9);
  }
  EXPECT_EQ(absorptionOf(soot, 4.0, 300.0), absorptionOf(soot, 4.0, 3000.0));
}

TEST(Species, AluminaAbsorbsAsPublished) {
  const SpeciesTable& alumina = table(Species::Alumina);
  // RADCAL: 0.017 x 1e6 per m and um of wavelength and unit of volume, over 3000 kg/m3.
  figure("molten alumina at 2.06 um [m2/kg]", absorptionOf(alumina, 2.06, 2700.0), 0.017e6 / 2.06 / 3000.0, 0.01, "RADCAL; three digits, linear between rows");
  figure("solid alumina at 2.06 um, 1200 K [m2/kg]", absorptionOf(alumina, 2.06, 1200.0), 0.00073e6 / 2.06 / 3970.0, 0.01, "the same");
  // Sapphire at 5 um: 0.9 per cm (Handbook of Optics II, chapter 33). Small clear spheres absorb 9 n/(n^2 + 2)^2 of the bulk by volume, n 1.66 here (1.62 in
  // fact).
  const double bulk = 9.0 * 1.66 / std::pow(1.66 * 1.66 + 2.0, 2) * 90.0 / 3970.0;
  figure("cold alumina at 5.1 um over sapphire's absorption at 5 um", absorptionOf(alumina, 5.0, 300.0), bulk, 0.25, "an exponential's two published forms");
  EXPECT_GT(absorptionOf(alumina, 12.0, 300.0), 100.0 * absorptionOf(alumina, 6.0, 300.0)) << "the lattice absorbs beyond 10 um";
}

/// A gas's absorption in the cells of a band, and its curve of growth, at a temperature between levels.
double levelled(const std::vector<double>& byLevel, const BetweenLevels& at) {
  return byLevel[at.lower] + (at.part > 0.0 ? at.part * (byLevel[at.lower + 1] - byLevel[at.lower]) : 0.0);
}

// Rationale: carbon dioxide and water vapour are laid out so that the mean of their product is nearly the product of their means. Expected: that, over all
// bands, temperatures from 300 to 3000 K and paths.
TEST(Species, GasesOverlapAtRandom) {
  const SpeciesTable &co2 = table(Species::CO2), &h2o = table(Species::H2O), &co = table(Species::CO);
  const auto worstOf = [](const SpeciesTable& one, const SpeciesTable& two, std::size_t fromLevel) {
    double worst = 0.0;
    for (const SpeciesBand& a : one.bands)
      for (const SpeciesBand& b : two.bands) {
        if (a.low_per_cm != b.low_per_cm || 1e4 / a.low_per_cm > 30.0) continue;
        EXPECT_EQ(a.cells, b.cells) << a.low_per_cm;
        for (std::size_t l = fromLevel; l < one.temperature_K.size(); ++l)
          for (double p = 0.001; p < 2.0; p *= 4.0)
            for (double q = 0.001; q < 2.0; q *= 4.0) {
              const auto passes = [&](double pp, double qq) {
                return cellMean(a, [&](double um) { return std::exp(-pp * one.absorption[l](um) - qq * two.absorption[l](um)); });
              };
              worst = std::max(worst, std::abs(passes(p, q) - passes(p, 0.0) * passes(0.0, q)));
            }
      }
    return worst;
  };
  bound("carbon dioxide and water vapour, product of transmittances, 300 to 3000 K", worstOf(co2, h2o, 0), 0.012, "orders found by annealing: 0.01");
  bound("the same from 850 K up", worstOf(co2, h2o, 3), 0.012, "the same");
  bound("carbon dioxide and monoxide, product of transmittances", worstOf(co2, co, 0), 0.012, "the same");
  bound("carbon monoxide and water vapour, product of transmittances", worstOf(co, h2o, 0), 0.012, "the same");
}

/// Two gases along a path, far end first.
struct Piece {
  double temperature_K, co2_atm_m, h2o_atm_m;
};

/// Radiance towards the end of a path, 3.6 to 4.9 um [W/(m2 sr)], three ways.
struct Radiances {
  double curtisGodson = 0.0, correlated = 0.0, uncorrelated = 0.0;
};
Radiances radiancesOf(const std::vector<Piece>& path, double low_um, double high_um) {
  const SpeciesTable* gases[] = {&table(Species::CO2), &table(Species::H2O)};
  Radiances sum;
  for (const SpeciesBand& band : gases[1]->bands) {
    const double middle_um = 2e4 / (band.low_per_cm + band.high_per_cm), width_um = 1e4 / band.low_per_cm - 1e4 / band.high_per_cm;
    if (middle_um < low_um || middle_um > high_um) continue;
    const SpeciesBand* bands[2] = {nullptr, &band};
    for (const SpeciesBand& b : gases[0]->bands)
      if (b.low_per_cm == band.low_per_cm) bands[0] = &b;
    // From the near end: what is emitted there comes through all that lies before it.
    double x[2] = {0.0, 0.0}, overlapTimesX[2] = {0.0, 0.0}, passedBefore = 1.0, passedBands = 1.0;
    double curtisGodson = 0.0, uncorrelated = 0.0;
    for (auto piece = path.rbegin(); piece != path.rend(); ++piece) {
      const double source = physics::planckRadiance(middle_um, piece->temperature_K), paths[2] = {piece->co2_atm_m, piece->h2o_atm_m};
      double depth = 0.0, own = 0.0;
      for (int g = 0; g < 2; ++g) {
        if (!bands[g]) continue;
        const BetweenLevels at = betweenLevels(*gases[g], piece->temperature_K);
        const double mean = levelled(bands[g]->mean_per_atm_m, at), overlap = levelled(bands[g]->overlap, at);
        own += curveOfGrowth(mean, overlap, paths[g]);
        x[g] += mean * paths[g];
        overlapTimesX[g] += overlap * mean * paths[g];
        if (x[g] > 0.0) depth += curveOfGrowth(1.0, overlapTimesX[g] / x[g], x[g]);
      }
      curtisGodson += source * (passedBefore - std::exp(-depth));
      passedBefore = std::exp(-depth);
      uncorrelated += source * passedBands * -std::expm1(-own);
      passedBands *= std::exp(-own);
    }
    const double correlated = cellMean(band, [&](double um) {
      double passed = 1.0, radiance = 0.0;
      for (auto piece = path.rbegin(); piece != path.rend(); ++piece) {
        const double own = std::exp(-absorptionOf(*gases[0], um, piece->temperature_K) * piece->co2_atm_m -
                                    absorptionOf(*gases[1], um, piece->temperature_K) * piece->h2o_atm_m);
        radiance += physics::planckRadiance(middle_um, piece->temperature_K) * passed * (1.0 - own);
        passed *= own;
      }
      return radiance;
    });
    sum.curtisGodson += curtisGodson * width_um;
    sum.correlated += correlated * width_um;
    sum.uncorrelated += uncorrelated * width_um;
  }
  return sum;
}

/// Through a jet's axis: 1800 K and 11 % of each gas in the middle, Gaussian, cold air at the edge. `reach`: to where the path goes, of its radius.
std::vector<Piece> jet(double radius_m, int pieces, double reach = 3.0) {
  std::vector<Piece> path;
  for (int i = 0; i < pieces; ++i) {
    const double at = reach * ((2 * i + 1.0) / pieces - 1.0), share = std::exp(-at * at), length_m = 2.0 * reach * radius_m / pieces;
    path.push_back({300.0 + 1500.0 * share, 0.11 * share * length_m, 0.11 * share * length_m});
  }
  return path;
}

// Rationale: paths are not of one temperature. Three ways: Curtis and Godson's mean of the curves of growth along the path; the steps followed along the path
// as the renderer does, fully correlated, many uniform slabs; and transmittances of bands multiplied slab by slab. Expected: the first two agree; the third is
// the error that is avoided. None is the truth, which needs lines; their difference is the size of what is unknown.
TEST(Species, PathsOfManyTemperatures) {
  struct Path {
    const char* what;
    std::vector<Piece> pieces;
    double low_um, high_um, tolerance;
  };
  const std::vector<Piece> layers{{1500.0, 0.1, 0.1}, {300.0, 0.1, 0.05}}, thin{{1500.0, 0.005, 0.005}, {300.0, 0.004, 0.02}};
  for (const Path& p : {Path{"jet of 0.5 m, 1800 K to 300 K", jet(0.5, 400), 3.6, 4.9, 0.02}, Path{"the same", jet(0.5, 400), 2.5, 3.0, 0.05},
                        Path{"hot behind cold, 0.1 atm m each", layers, 3.6, 4.9, 0.04}, Path{"the same", layers, 2.5, 3.0, 0.1},
                        Path{"hot behind cold, 0.005 atm m each", thin, 3.6, 4.9, 0.04}}) {
    const Radiances r = radiancesOf(p.pieces, p.low_um, p.high_um);
    char what[160];
    std::snprintf(what, sizeof what, "%s, radiance %.2g-%.2g um, steps along the path over Curtis-Godson", p.what, p.low_um, p.high_um);
    figure(what, r.correlated / r.curtisGodson, 1.0, p.tolerance, "two approximations: their difference is the size of what is unknown");
    std::snprintf(what, sizeof what, "%s, radiance %.2g-%.2g um, band transmittances of slabs multiplied over Curtis-Godson", p.what, p.low_um, p.high_um);
    figure(what, r.uncorrelated / r.curtisGodson, 1.0, 0.15, "the error of multiplying, which depends on the number of slabs");
  }
  const double fine = radiancesOf(jet(0.5, 1600), 3.6, 4.9).correlated;
  figure("jet of 0.5 m, 3.6-4.9 um, 400 slabs over 1600", radiancesOf(jet(0.5, 400), 3.6, 4.9).correlated / fine, 1.0, 1e-3, "second order in the step");
  figure("the same, 32 slabs", radiancesOf(jet(0.5, 32), 3.6, 4.9).correlated / fine, 1.0, 0.02, "second order in the step: 64 times that of 256");
}

// Rationale: absorption is linear between levels of temperature. Each inner level is left out in turn: what its neighbours give is at twice the distance, so
// the error between levels is about a quarter of this.
TEST(Species, LevelsAreCloseEnough) {
  for (Species species : {Species::CO2, Species::H2O, Species::CO}) {
    const SpeciesTable& gas = table(species);
    double worst = 0.0, hotWorst = 0.0;
    for (std::size_t l = 1; l + 1 < gas.temperature_K.size(); ++l) {
      const double t = gas.temperature_K[l], part = (t - gas.temperature_K[l - 1]) / (gas.temperature_K[l + 1] - gas.temperature_K[l - 1]);
      for (double path : {0.01, 0.1}) {
        double has = 0.0, wanted = 0.0;
        for (const SpeciesBand& band : gas.bands) {
          const double um = 2e4 / (band.low_per_cm + band.high_per_cm);
          if (um < 3.6 || um > 4.9) continue;
          const double weight = physics::planckRadiance(um, t) * (1e4 / band.low_per_cm - 1e4 / band.high_per_cm);
          wanted += weight * cellMean(band, [&](double w) { return -std::expm1(-gas.absorption[l](w) * path); });
          has += weight *
                 cellMean(band, [&](double w) { return -std::expm1(-((1.0 - part) * gas.absorption[l - 1](w) + part * gas.absorption[l + 1](w)) * path); });
        }
        worst = std::max(worst, std::abs(has / wanted - 1.0));
        if (t > 800.0 && t < 2400.0) hotWorst = std::max(hotWorst, std::abs(has / wanted - 1.0));  // beyond 2500 K water's strength is held: a kink
      }
    }
    bound(gas.name + ", 3.6-4.9 um emissivity with a level left out, relative, worst", worst, 0.2, "curvature of the absorption over temperature");
    bound(gas.name + ", the same from 850 to 2000 K", hotWorst, 0.1, "curvature of the absorption over temperature");
  }
}

// What planning and loading cost.
TEST(Species, TablesAreSmall) {
  std::uintmax_t bytes = 0;
  for (const auto& file : fs::directory_iterator(libraryFolder() / "gases")) bytes += file.file_size();
  bound("tables of the species [bytes]", static_cast<double>(bytes), 4e5, "wanted");
  std::vector<double> knots;
  for (Species species : {Species::CO2, Species::H2O, Species::CO, Species::Soot, Species::Alumina})
    for (const Spectrum& level : table(species).absorption) {
      EXPECT_EQ(level.validLow(), 0.3);
      EXPECT_EQ(level.validHigh(), 30.0);
      for (double um : level.knots())
        if (um > 3.6 && um < 4.9) knots.push_back(um);
    }
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  bound("wavelengths at which any species jumps or bends, 3.6-4.9 um", static_cast<double>(knots.size()), 300.0, "wanted: all gases and levels share theirs");
}

TEST(Species, TemperaturesBeyondTheLevelsAreHeld) {
  const SpeciesTable& co2 = table(Species::CO2);
  EXPECT_EQ(absorptionOf(co2, 4.3, 200.0), absorptionOf(co2, 4.3, 300.0));
  EXPECT_EQ(absorptionOf(co2, 4.3, 4000.0), absorptionOf(co2, 4.3, 3000.0));
  EXPECT_NEAR(absorptionOf(co2, 4.3, 775.0), 0.5 * (absorptionOf(co2, 4.3, 700.0) + absorptionOf(co2, 4.3, 850.0)), 1e-12 * absorptionOf(co2, 4.3, 700.0));
  EXPECT_EQ(absorptionOf(co2, 1.0, 1800.0), 0.0);
  EXPECT_THROW(absorptionOf(co2, 31.0, 1800.0), OutsideSpectrum);
  EXPECT_EQ(&table(Species::CO2), &co2) << "read once";
  EXPECT_NE(co2.source.find("RADCAL"), std::string::npos);
}

TEST(Species, WhatCannotBeIsRefused) {
  const TemporaryFolder folder;
  const std::string head = "from [1/cm], to [1/cm], cells [1], mean 300 K [1/(atm m)], mean 500 K [1/(atm m)], overlap 300 K [1], overlap 500 K [1]\n";
  struct Wrong {
    Species species;
    std::string content, where, word;
  };
  for (const Wrong& w :
       {Wrong{Species::CO2, head + "2000,2025,12,1,2,0.1\n", ":2:1", "6 cells"}, Wrong{Species::CO2, head + "2000,2025,7,1,2,0.1,0.1\n", ":2:1", "7.0"},
        Wrong{Species::CO2, head + "2000,2025,12,-1,2,0.1,0.1\n", ":2:1", "mean 300 K"},
        Wrong{Species::CO2, head + "2000,2025,12,1,2,0.1,0\n", ":2:1", "overlap 500 K"},
        Wrong{Species::CO2, head + "2000,2025,12,1,2,0.1,0.1\n2010,2035,12,1,2,0.1,0.1\n", ":3:1", "overlap or do not rise"},
        Wrong{Species::CO2, head, ":1:1", "no rows"}, Wrong{Species::CO2, "from [1/cm], to [um]\n1,2\n", ":1:17", "to [1/cm]"},
        Wrong{Species::CO2, "from [1/cm], to [1/cm], cells [1], mean 500 K [1/(atm m)], mean 300 K [1/(atm m)]\n1,2,1,1,1\n", ":1:", "level of temperature"},
        Wrong{Species::CO2, "from [1/cm], to [1/cm], cells [1], mean 300 K [1/(atm m)], overlap 400 K [1]\n1,2,1,1,1\n", ":1:", "other levels"},
        Wrong{Species::Soot, "wavelength [um], absorption 300 K [1/m]\n1,2\n0.5,3\n", ":3:1", "do not rise"},
        Wrong{Species::Soot, "wavelength [um], absorption 300 K [m2/kg]\n1,2\n", ":1:", "[1/m]"},
        Wrong{Species::Soot, "wavelength [um], absorption 300 K [1/m], more [1]\n1,2,3\n", ":1:", "a column too many"},
        Wrong{Species::Soot, "wavelength [um], absorption 300 K [1/m]\n1,two\n", ":2:3", "not a finite number"}}) {
    const std::string file = folder.put("made.csv", w.content);
    try {
      readSpeciesTable(w.species, file);
      ADD_FAILURE() << w.content;
    } catch (const UserError& e) {
      EXPECT_NE(std::string(e.what()).find(file + w.where), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(w.word), std::string::npos) << e.what();
    }
  }
  EXPECT_THROW(speciesTable(Species::CO, folder.path()), UserError);
}

}  // namespace
}  // namespace pitviper::test
