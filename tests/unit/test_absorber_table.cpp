// Air with structure: amounts against closed forms, transmittance and thermal radiance against LOWTRAN 7, and broken files.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "atmosphere/absorber_table.hpp"
#include "sim/parameters/error.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "sim/radiometry/spectrum.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

// The earth of LOWTRAN's US standard and mid-latitude atmospheres.
constexpr double kEarth_m = 6371230.0;

const AbsorberTable& standardAir() {
  static const AbsorberTable table = AbsorberTable::read(fs::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/us76_rural.air");
  return table;
}

const AbsorberTable& summerAir() {
  static const AbsorberTable table = [] {
    AbsorberTable t = standardAir();
    t.setProfile(AirProfile::read(fs::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/climates/midlatitude_summer.csv", {}), {});
    return t;
  }();
  return table;
}

const AbsorberTable& cleanAir() {
  static const AbsorberTable table = [] {
    AbsorberTable t = standardAir();
    t.removeAerosol();
    return t;
  }();
  return table;
}

enum class PathKind { Horizontal, WithoutAerosol, Summer, Slant };

// LOWTRAN's horizontal path is homogeneous: no curvature.
AbsorberAmounts horizontal(const AbsorberTable& air, double range_km) {
  AbsorberAmounts w = air.densities(0.0);
  for (double& amount : w.amount_km) amount *= range_km;
  return w;
}

// Straight from the ground to a height; LOWTRAN's is bent, which makes it up to 0.3 % longer (slant_geometry.csv).
double slantRange_m(double zenith_deg, double height_m) {
  const double b = kEarth_m * std::cos(zenith_deg * kPi / 180.0);
  return height_m * (2.0 * kEarth_m + height_m) / (b + std::sqrt(b * b + height_m * (2.0 * kEarth_m + height_m)));
}

AbsorberAmounts slant(double zenith_deg, double height_km) {
  return standardAir().amounts(0.0, std::cos(zenith_deg * kPi / 180.0), slantRange_m(zenith_deg, 1e3 * height_km), kEarth_m);
}

const AbsorberTable& airOf(PathKind path) { return path == PathKind::WithoutAerosol ? cleanAir() : path == PathKind::Summer ? summerAir() : standardAir(); }

// extent: range [km] of a horizontal path, upper end [km] of a slant one from the ground (100: to space).
AbsorberAmounts amountsOf(PathKind path, double zenith_deg, double extent_km) {
  return path == PathKind::Slant ? slant(zenith_deg, extent_km) : horizontal(airOf(path), extent_km);
}

struct Checkpoint {
  PathKind path;
  double zenith_deg, extent_km, wavenumber_per_cm, transmittance;
};

// LOWTRAN 7 rev 4.2 (Kneizys et al. 1988; release of February 1992), US Standard 1976 and mid-latitude summer, rural aerosol of 23 km visibility
// or none.
// clang-format off
const Checkpoint kCheckpoints[] = {
    {PathKind::Horizontal, 0, 1, 18180, 0.84394}, {PathKind::Horizontal, 0, 1, 9430, 0.93277}, {PathKind::Horizontal, 0, 1, 6060, 0.94727},
    {PathKind::Horizontal, 0, 1, 4545, 0.91276}, {PathKind::Horizontal, 0, 1, 3030, 0.46933}, {PathKind::Horizontal, 0, 1, 2500, 0.93839},
    {PathKind::Horizontal, 0, 1, 2270, 0.05459}, {PathKind::Horizontal, 0, 1, 2175, 0.77132}, {PathKind::Horizontal, 0, 1, 1175, 0.81021},
    {PathKind::Horizontal, 0, 1, 1000, 0.92158}, {PathKind::Horizontal, 0, 1, 835, 0.88312}, {PathKind::Horizontal, 0, 5, 18180, 0.42812},
    {PathKind::Horizontal, 0, 5, 9430, 0.71017}, {PathKind::Horizontal, 0, 5, 6060, 0.79518}, {PathKind::Horizontal, 0, 5, 4545, 0.74332},
    {PathKind::Horizontal, 0, 5, 3030, 0.12566}, {PathKind::Horizontal, 0, 5, 2500, 0.75717}, {PathKind::Horizontal, 0, 5, 2270, 0.0003842},
    {PathKind::Horizontal, 0, 5, 2175, 0.4391}, {PathKind::Horizontal, 0, 5, 1175, 0.52402}, {PathKind::Horizontal, 0, 5, 1000, 0.71938},
    {PathKind::Horizontal, 0, 5, 835, 0.60513}, {PathKind::Horizontal, 0, 20, 18180, 0.0336}, {PathKind::Horizontal, 0, 20, 9430, 0.25696},
    {PathKind::Horizontal, 0, 20, 6060, 0.4308}, {PathKind::Horizontal, 0, 20, 4545, 0.40462}, {PathKind::Horizontal, 0, 20, 3030, 0.004998},
    {PathKind::Horizontal, 0, 20, 2500, 0.35405}, {PathKind::Horizontal, 0, 20, 2270, 0}, {PathKind::Horizontal, 0, 20, 2175, 0.09414},
    {PathKind::Horizontal, 0, 20, 1175, 0.15458}, {PathKind::Horizontal, 0, 20, 1000, 0.30985}, {PathKind::Horizontal, 0, 20, 835, 0.16443},
    {PathKind::WithoutAerosol, 0, 10, 18180, 0.88973}, {PathKind::WithoutAerosol, 0, 10, 6060, 0.91328}, {PathKind::WithoutAerosol, 0, 10, 2500, 0.68442},
    {PathKind::WithoutAerosol, 0, 10, 2175, 0.28971}, {PathKind::WithoutAerosol, 0, 10, 1040, 0.49498}, {PathKind::WithoutAerosol, 0, 10, 900, 0.54518},
    {PathKind::Summer, 0, 1, 18180, 0.84412}, {PathKind::Summer, 0, 1, 9430, 0.93034}, {PathKind::Summer, 0, 1, 4000, 0.11388},
    {PathKind::Summer, 0, 1, 2630, 0.83126}, {PathKind::Summer, 0, 1, 2040, 0.42975}, {PathKind::Summer, 0, 1, 1000, 0.80979},
    {PathKind::Summer, 0, 1, 835, 0.67424}, {PathKind::Summer, 0, 5, 18180, 0.42857}, {PathKind::Summer, 0, 5, 9430, 0.70339},
    {PathKind::Summer, 0, 5, 4000, 0.0007878}, {PathKind::Summer, 0, 5, 2630, 0.57226}, {PathKind::Summer, 0, 5, 2040, 0.06718},
    {PathKind::Summer, 0, 5, 1000, 0.39149}, {PathKind::Summer, 0, 5, 835, 0.16818}, {PathKind::Slant, 60, 1, 2500, 0.902},
    {PathKind::Slant, 60, 1, 2270, 0.01566}, {PathKind::Slant, 60, 1, 1000, 0.88489}, {PathKind::Slant, 60, 1, 835, 0.83327},
    {PathKind::Slant, 0, 3, 18180, 0.75262}, {PathKind::Slant, 0, 3, 4545, 0.87799}, {PathKind::Slant, 0, 3, 2630, 0.84949},
    {PathKind::Slant, 0, 3, 1000, 0.88537}, {PathKind::Slant, 80, 5, 9430, 0.49092}, {PathKind::Slant, 80, 5, 2500, 0.48887},
    {PathKind::Slant, 80, 5, 2395, 0.03315}, {PathKind::Slant, 80, 5, 1250, 0.05205}, {PathKind::Slant, 80, 5, 1000, 0.53396},
    {PathKind::Slant, 0, 10, 18180, 0.67667}, {PathKind::Slant, 0, 10, 2860, 0.78284}, {PathKind::Slant, 0, 10, 2500, 0.84503},
    {PathKind::Slant, 0, 10, 2270, 0.001332}, {PathKind::Slant, 0, 10, 1055, 0.69429}, {PathKind::Slant, 0, 10, 900, 0.8657},
    {PathKind::Slant, 0, 100, 20000, 0.59123}, {PathKind::Slant, 0, 100, 9430, 0.86859}, {PathKind::Slant, 0, 100, 5880, 0.9091},
    {PathKind::Slant, 0, 100, 2500, 0.83688}, {PathKind::Slant, 0, 100, 2325, 0}, {PathKind::Slant, 0, 100, 1040, 0.39765},
    {PathKind::Slant, 0, 100, 1000, 0.75923}, {PathKind::Slant, 60, 100, 20000, 0.35017}, {PathKind::Slant, 60, 100, 9430, 0.75599},
    {PathKind::Slant, 60, 100, 5880, 0.83894}, {PathKind::Slant, 60, 100, 2500, 0.71304}, {PathKind::Slant, 60, 100, 2325, 0},
    {PathKind::Slant, 60, 100, 1040, 0.20894}, {PathKind::Slant, 60, 100, 1000, 0.61838}, {PathKind::Slant, 80, 100, 20000, 0.05102},
    {PathKind::Slant, 80, 100, 9430, 0.45252}, {PathKind::Slant, 80, 100, 5880, 0.63226}, {PathKind::Slant, 80, 100, 2500, 0.40324},
    {PathKind::Slant, 80, 100, 2325, 0}, {PathKind::Slant, 80, 100, 1040, 0.03286}, {PathKind::Slant, 80, 100, 1000, 0.32662},
};

struct BandMean {
  PathKind path;
  double zenith_deg, extent_km, midwave, longwave;
};

// Means of the same over wavelength, 3 to 5 um and 8 to 12 um.
const BandMean kBandMeans[] = {
    {PathKind::Horizontal, 0, 1, 0.6058, 0.8727},
    {PathKind::Horizontal, 0, 5, 0.3563, 0.6224},
    {PathKind::Horizontal, 0, 20, 0.1271, 0.2184},
    {PathKind::WithoutAerosol, 0, 10, 0.2767, 0.4976},
    {PathKind::Summer, 0, 1, 0.5214, 0.7312},
    {PathKind::Summer, 0, 5, 0.2638, 0.2914},
    {PathKind::Slant, 60, 1, 0.5366, 0.8236},
    {PathKind::Slant, 0, 3, 0.5295, 0.8251},
    {PathKind::Slant, 80, 5, 0.2082, 0.4301},
    {PathKind::Slant, 0, 10, 0.4811, 0.7937},
    {PathKind::Slant, 0, 100, 0.4726, 0.7453},
    {PathKind::Slant, 60, 100, 0.3565, 0.6177},
    {PathKind::Slant, 80, 100, 0.1802, 0.3559},
};
// clang-format on

// Mean over wavelength on LOWTRAN's grid of 5 1/cm.
template <typename F>
double bandMean(double low_um, double high_um, F&& value) {
  double sum = 0.0, weight = 0.0;
  for (double nu = 700.0; nu <= 25000.0; nu += 5.0) {
    const double wavelength = 1e4 / nu;
    if (wavelength < low_um || wavelength > high_um) continue;
    const double w = wavelength * wavelength;
    sum += w * value(wavelength);
    weight += w;
  }
  return sum / weight;
}

TEST(AbsorberTable, TransmittanceIsLowtransAtCheckpoints) {
  double worst = 0.0;
  for (const Checkpoint& c : kCheckpoints) {
    const double tau = airOf(c.path).transmittance(1e4 / c.wavenumber_per_cm, amountsOf(c.path, c.zenith_deg, c.extent_km));
    // The fit is within 0.0043 of every 5 1/cm of its data; here with straight paths in place of LOWTRAN's bent ones.
    EXPECT_NEAR(tau, c.transmittance, 0.005) << c.wavenumber_per_cm << " 1/cm, zenith " << c.zenith_deg << ", " << c.extent_km << " km";
    worst = std::max(worst, std::abs(tau - c.transmittance));
  }
  bound("air table against LOWTRAN 7, 93 checkpoints, difference of transmittance", worst, 0.005, "fit 0.0043; refraction left out");
}

TEST(AbsorberTable, BandMeansAreLowtrans) {
  double worst = 0.0;
  for (const BandMean& b : kBandMeans) {
    const AbsorberAmounts w = amountsOf(b.path, b.zenith_deg, b.extent_km);
    const auto mean = [&](double low, double high) { return bandMean(low, high, [&](double um) { return airOf(b.path).transmittance(um, w); }); };
    const double midwave = mean(3.0, 5.0) / b.midwave - 1.0, longwave = mean(8.0, 12.0) / b.longwave - 1.0;
    EXPECT_LT(std::abs(midwave), 0.01) << "zenith " << b.zenith_deg << ", " << b.extent_km << " km";
    EXPECT_LT(std::abs(longwave), 0.01) << "zenith " << b.zenith_deg << ", " << b.extent_km << " km";
    worst = std::max({worst, std::abs(midwave), std::abs(longwave)});
  }
  bound("air table against LOWTRAN 7, 3-5 and 8-12 um means, relative", worst, 0.01, "fit");
}

// ---- Amounts against closed forms ---------------------------------------------------------------------------------------------------

AbsorberTable made(const std::string& levels) {
  std::istringstream in("pitviper-air 1\namount a 1 gas\n" + levels + "bin 800 0 1\nbin 900 0 1\n");
  return AbsorberTable::read(in, "made");
}

TEST(AbsorberTable, ConstantDensityIsAChord) {
  const AbsorberTable air = made("level 0 300 1\nlevel 4000 300 1\nlevel 10000 300 1\n");
  for (double e : {-0.02, 0.0, 1e-6, 0.1, 0.5, 1.0})
    for (double h : {0.0, 1000.0, 9999.0}) {
      const double r = kEarth_m + h, b = r * e, top = kEarth_m + 10000.0;
      const double length = -b + std::sqrt(b * b + (top - r) * (top + r));
      EXPECT_NEAR(air.amounts(h, e, INFINITY, kEarth_m).amount_km[0] / (1e-3 * length), 1.0, 1e-9) << h << " " << e;
      EXPECT_NEAR(air.amounts(h, e, 0.3 * length, kEarth_m).amount_km[0] / (0.3e-3 * length), 1.0, 1e-9) << h << " " << e;
    }
  // From above the top, down through it and out again, and past it.
  EXPECT_NEAR(air.amounts(20000.0, -1.0, 15000.0, kEarth_m).amount_km[0], 5.0, 1e-9);
  const double grazing = -std::sqrt(1.0 - std::pow((kEarth_m + 5000.0) / (kEarth_m + 20000.0), 2));
  const double chord = 2.0 * std::sqrt(std::pow(kEarth_m + 10000.0, 2) - std::pow(kEarth_m + 5000.0, 2));
  EXPECT_NEAR(air.amounts(20000.0, grazing, INFINITY, kEarth_m).amount_km[0] / (1e-3 * chord), 1.0, 1e-7);
  EXPECT_EQ(air.amounts(20000.0, 0.3, INFINITY, kEarth_m).amount_km[0], 0.0);
  EXPECT_EQ(air.amounts(5000.0, 0.3, 0.0, kEarth_m).amount_km[0], 0.0);
}

TEST(AbsorberTable, ExponentialAirUpwards) {
  const double scale = 2000.0;
  std::ostringstream levels;
  levels.precision(17);
  for (int i = 0; i <= 20; ++i) levels << "level " << 1000 * i << " 300 " << std::exp(-1000.0 * i / scale) << "\n";
  const AbsorberTable air = made(levels.str());
  EXPECT_NEAR(air.amounts(0.0, 1.0, INFINITY, kEarth_m).amount_km[0] / (2.0 * (1.0 - std::exp(-10.0))), 1.0, 1e-9);
  EXPECT_NEAR(air.amounts(7000.0, -1.0, 4500.0, kEarth_m).amount_km[0] / (2.0 * (std::exp(-1.25) - std::exp(-3.5))), 1.0, 1e-9);
  // Along a grazing line: against 20000 points of the middle.
  for (double e : {-0.015, 0.0, 0.01, 0.2}) {
    double sum = 0.0;
    const int n = 20000;
    const double range = 300000.0, r = kEarth_m + 1500.0;
    for (int i = 0; i < n; ++i) {
      const double s = (i + 0.5) * range / n, h = 1500.0 + s * (2.0 * r * e + s) / (r + std::sqrt(r * r + s * (2.0 * r * e + s)));
      if (h < 20000.0) sum += std::exp(-h / scale) * 1e-3 * range / n;
    }
    // Midpoint rule: 15 m steps over a scale of 2 km.
    EXPECT_NEAR(air.amounts(1500.0, e, range, kEarth_m).amount_km[0] / sum, 1.0, 2e-5) << e;
  }
}

TEST(AbsorberTable, PathsAddAndAreTheSameFromEitherEnd) {
  for (double h : {0.0, 700.0, 3300.0, 12000.0})
    for (double e : {-0.05, -0.01, 0.0, 0.02, 0.3, 1.0})
      for (double range : {50.0, 4000.0, 150000.0}) {
        const double r = kEarth_m + h, grown = range * (2.0 * r * e + range), end = std::sqrt(r * r + grown);
        const double endHeight = h + grown / (r + end), endSine = (r * e + range) / end;
        if (endHeight < -500.0) continue;
        const AbsorberAmounts there = standardAir().amounts(h, e, range, kEarth_m), back = standardAir().amounts(endHeight, -endSine, range, kEarth_m);
        const double middle = 0.37 * range, grownMiddle = middle * (2.0 * r * e + middle), rm = std::sqrt(r * r + grownMiddle);
        const AbsorberAmounts parts =
            standardAir().amounts(h, e, middle, kEarth_m) + standardAir().amounts(h + grownMiddle / (r + rm), (r * e + middle) / rm, range - middle, kEarth_m);
        for (size_t k = 0; k < standardAir().absorbers().size(); ++k) {
          // 1e-9 m of height in 6e6 m, and the quadrature over other pieces.
          EXPECT_NEAR(there.amount_km[k], back.amount_km[k], 1e-6 * there.amount_km[k] + 1e-12) << h << " " << e << " " << range << " " << k;
          EXPECT_NEAR(there.amount_km[k], parts.amount_km[k], 1e-6 * there.amount_km[k] + 1e-12) << h << " " << e << " " << range << " " << k;
        }
      }
}

TEST(AbsorberTable, QuadratureIsAsGoodAsStated) {
  double worst = 0.0;
  for (double h : {0.0, 1500.0, 11000.0})
    for (double e : {-0.01, 0.0, 0.05, 1.0}) {
      const AbsorberAmounts w = standardAir().amounts(h, e, INFINITY, kEarth_m);
      const AbsorberAmounts fine = standardAir().stations(h, e, INFINITY, kEarth_m, 2000).back().amounts;
      for (size_t k = 0; k < standardAir().absorbers().size(); ++k)
        if (fine.amount_km[k] > 0.0) worst = std::max(worst, std::abs(w.amount_km[k] / fine.amount_km[k] - 1.0));
    }
  bound("amounts, 6 points between levels against 2000 more cuts, relative", worst, 1e-6, "Gauss-Legendre");
}

TEST(AbsorberTable, ColumnsOfTheStandardAtmosphere) {
  // Standard values: 8.0 km of sea-level air at 288 K above the ground; 0.343 atm cm of ozone; 1.42 g/cm2 of water (Anderson et al. 1986).
  const AbsorberAmounts w = standardAir().amounts(0.0, 1.0, INFINITY, kEarth_m);
  const auto of = [&](const std::string& name) {
    for (size_t k = 0; k < standardAir().absorbers().size(); ++k)
      if (standardAir().absorbers()[k].name == name) return w.amount_km[k];
    return 0.0;
  };
  // Scale height R T / (M g) = 8.314 x 288.2 / (0.02896 x 9.807) m, less 0.3 % for gravity falling off and trapezoids of the table.
  figure("column of air over its sea-level density [km]", of("rayleigh"), 8.437, 4e-3, "R T / (M g)");
  // 2.66e-2 ppm at sea level: 2.66e-8 x 273.15/288.2 x 0.99975 x 1e5 cm = 2.520e-3 atm cm per km.
  figure("column of ozone [atm cm]", of("o3_linear") * 2.520e-3, 0.3434, 5e-3, "Anderson et al. 1986");
}

// ---- Visibility ------------------------------------------------------------------------------------------------------------------------

TEST(AbsorberTable, VisibilityScalesTheHaze) {
  for (double v : {10.0, 23.0, 50.0}) {
    AbsorberTable hazy = standardAir();
    hazy.setVisibility(v);
    const double haze = hazy.opticalDepth(0.55, horizontal(hazy, 1.0)) - cleanAir().opticalDepth(0.55, horizontal(cleanAir(), 1.0));
    // Koschmieder: a contrast of 2 % remains at V. LOWTRAN's 23 km is 0.158 per km of haze at 0.55 um.
    figure("extinction of haze at 0.55 um, visibility " + std::to_string(static_cast<int>(v)) + " km [1/km]", haze, 3.912 / v - 0.0116, 0.01,
           "Koschmieder less Rayleigh");
  }
}

// ---- Thermal radiance --------------------------------------------------------------------------------------------------------------------

TEST(PathRadiance, IsothermalAirIsKirchhoffs) {
  const AbsorberTable air = made("level 0 280 1\nlevel 1000 280 0.5\nlevel 9000 280 0.01\n");
  for (double e : {0.01, 0.5, 1.0})
    for (double range : {1.0, 3000.0, 40000.0}) {
      const double expected = physics::planckRadiance(12.0, 280.0) * -std::expm1(-air.opticalDepth(12.0, air.amounts(10.0, e, range, kEarth_m)));
      EXPECT_NEAR(air.pathRadiance(12.0, 10.0, e, range, kEarth_m) / expected, 1.0, 1e-8);  // quadrature over other pieces
    }
}

TEST(PathRadiance, OpaqueAirShowsWhatIsNear) {
  // 4.26 um: nothing passes 100 m.
  EXPECT_NEAR(standardAir().pathRadiance(4.26, 0.0, 1.0, 5000.0, kEarth_m) / physics::planckRadiance(4.26, 288.2), 1.0, 3e-3);
  EXPECT_NEAR(standardAir().pathRadiance(4.26, 5000.0, -1.0, 5000.0, kEarth_m) / physics::planckRadiance(4.26, 255.7), 1.0, 6e-3);
}

TEST(PathRadiance, ConvergesInStations) {
  double worst = 0.0;
  for (double height : {0.0, 5000.0, 10000.0})
    for (double e : {-0.9, -0.2, 0.17, 1.0}) {
      const double range = e < 0.0 ? -height / e : INFINITY;
      if (range <= 0.0) continue;
      const auto coarse = standardAir().stations(height, e, range, kEarth_m), fine = standardAir().stations(height, e, range, kEarth_m, 512);
      for (const auto& [low, high] : {std::pair{3.0, 5.0}, std::pair{8.0, 12.0}}) {
        const double a = bandMean(low, high, [&](double um) { return standardAir().pathRadiance(um, coarse); });
        const double b = bandMean(low, high, [&](double um) { return standardAir().pathRadiance(um, fine); });
        worst = std::max(worst, std::abs(a / b - 1.0));
      }
    }
  bound("path radiance, 32 stations against 512, band means, relative", worst, 4e-3, "B linear in optical depth between stations");
}

// ---- Against all of LOWTRAN's tables, where they are ----------------------------------------------------------------------------------------

class Reference : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* named = std::getenv("PITVIPER_REFERENCE_DATA");
    folder_ = (named ? fs::path(named) : fs::path(PITVIPER_SOURCE_DIR) / "../shared/data") / "lowtran7";
    if (!fs::exists(folder_ / "space_us76_rural23.csv")) GTEST_SKIP() << "reference tables are not in " << folder_ << "; they are no part of the project";
  }
  using Table = std::vector<std::vector<double>>;
  Table rows(const std::string& file) const {
    std::ifstream in(folder_ / file);
    Table table;
    for (std::string line; std::getline(in, line);) {
      if (line.empty() || !(line[0] >= '0' && line[0] <= '9')) continue;
      std::vector<double> row;
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell.empty() ? NAN : std::stod(cell));
      table.push_back(row);
    }
    EXPECT_GT(table.size(), 100u) << file;
    return table;
  }
  // Largest difference of a column from this air.
  double worst(const Table& table, size_t column, const AbsorberTable& air, const AbsorberAmounts& w, size_t over = 0) const {
    double most = 0.0;
    for (const auto& row : table) {
      const double expected = over ? row[column] / row[over] : row[column];
      most = std::max(most, std::abs(air.transmittance(1e4 / row[0], w) - expected));
    }
    return most;
  }
  fs::path folder_;
};

constexpr double kRanges_km[] = {0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0};
constexpr double kHeights_km[] = {1.0, 3.0, 5.0, 10.0};
constexpr double kZeniths_deg[] = {0.0, 60.0, 80.0};

TEST_F(Reference, Transmittance) {
  const std::string why = "fit 0.0043 at every 5 1/cm; straight instead of bent paths";
  const auto us = rows("horiz_tau_us76_rural23.csv"), clean = rows("horiz_tau_us76_noaer.csv"), summer = rows("horiz_tau_mls_rural23.csv");
  double most[5] = {};
  for (size_t i = 0; i < std::size(kRanges_km); ++i) {
    most[0] = std::max(most[0], worst(us, 2 + i, standardAir(), horizontal(standardAir(), kRanges_km[i])));
    most[1] = std::max(most[1], worst(clean, 2 + i, cleanAir(), horizontal(cleanAir(), kRanges_km[i])));
    most[2] = std::max(most[2], worst(summer, 2 + i, summerAir(), horizontal(summerAir(), kRanges_km[i])));
  }
  const auto slants = rows("slant_tau_us76_rural23.csv"), space = rows("space_us76_rural23.csv"), sun = rows("solar_direct_us76_rural23.csv");
  for (size_t z = 0; z < 3; ++z) {
    for (size_t h = 0; h < 4; ++h) most[3] = std::max(most[3], worst(slants, 2 + 3 * h + z, standardAir(), slant(kZeniths_deg[z], kHeights_km[h])));
    most[4] = std::max(most[4], worst(space, 2 + z, standardAir(), slant(kZeniths_deg[z], 100.0)));
  }
  size_t column = 3;
  for (double zenith : {0.0, 30.0, 45.0, 60.0, 75.0}) most[4] = std::max(most[4], worst(sun, column++, standardAir(), slant(zenith, 100.0), 2));
  const char* names[] = {"horizontal 0.1-20 km", "horizontal without aerosol", "horizontal, mid-latitude summer", "slant", "to space and the sun's"};
  for (size_t i = 0; i < 5; ++i) bound(std::string("transmittance against all of LOWTRAN 7, ") + names[i], most[i], 0.005, why);
}

// LOWTRAN gives each 1 km layer one temperature, the mean: at opaque wavelengths it shows the middle of the layer (6 to 7 % less than the air at
// the ground, 3-5 um). Done the same way, this air agrees; pathRadiance() itself goes to the limit of thin layers.
double layeredRadiance(double wavelength_um, std::span<const PathStation> levels) {
  double radiance = 0.0, before = 1.0;
  for (size_t i = 1; i < levels.size(); ++i) {
    const double tau = standardAir().transmittance(wavelength_um, levels[i].amounts);
    radiance += physics::planckRadiance(wavelength_um, 0.5 * (levels[i - 1].temperature_K + levels[i].temperature_K)) * (before - tau);
    before = tau;
  }
  return radiance;
}

TEST_F(Reference, ThermalRadiance) {
  const auto meanOf = [](const Table& table, size_t column, double low, double high) {
    double sum = 0.0, weight = 0.0;
    for (const auto& row : table) {
      if (row[1] < low || row[1] > high || std::isnan(row[column])) continue;
      sum += row[1] * row[1] * row[column];
      weight += row[1] * row[1];
    }
    return sum / weight;
  };
  const std::pair<double, double> bands[] = {{3.0, 5.0}, {8.0, 12.0}};
  double most[3] = {}, thin = 0.0;
  const auto compare = [&](double& worstOf, const Table& table, size_t column, auto&& radiance) {
    for (const auto& [low, high] : bands) worstOf = std::max(worstOf, std::abs(bandMean(low, high, radiance) / meanOf(table, column, low, high) - 1.0));
  };
  const auto level = rows("horiz_rad_us76_rural23.csv"), up = rows("slant_radup_us76_rural23.csv"), down = rows("slant_raddown_us76_rural23.csv"),
             space = rows("space_us76_rural23.csv");
  for (size_t i = 0; i < std::size(kRanges_km); ++i) {
    const AbsorberAmounts w = horizontal(standardAir(), kRanges_km[i]);
    compare(most[0], level, 2 + i, [&](double um) { return physics::planckRadiance(um, 288.2) * -std::expm1(-standardAir().opticalDepth(um, w)); });
  }
  for (size_t z = 0; z < 3; ++z) {
    const double sine = std::cos(kZeniths_deg[z] * kPi / 180.0);
    for (size_t h = 0; h < 4; ++h) {
      const double height = 1e3 * kHeights_km[h], range = slantRange_m(kZeniths_deg[z], height);
      const auto fromGround = standardAir().stations(0.0, sine, range, kEarth_m, 0);
      const auto fromAbove = standardAir().stations(height, -(kEarth_m * sine + range) / (kEarth_m + height), range, kEarth_m, 0);
      compare(most[1], up, 2 + 3 * h + z, [&](double um) { return layeredRadiance(um, fromGround); });
      compare(most[2], down, 2 + 3 * h + z, [&](double um) { return layeredRadiance(um, fromAbove); });
      const auto close = standardAir().stations(0.0, sine, range, kEarth_m);
      compare(thin, up, 2 + 3 * h + z, [&](double um) { return standardAir().pathRadiance(um, close); });
    }
    const auto sky = standardAir().stations(0.0, sine, INFINITY, kEarth_m, 0);
    compare(most[1], space, 5 + z, [&](double um) { return layeredRadiance(um, sky); });
  }
  bound("thermal radiance against LOWTRAN 7, horizontal, band means", most[0], 0.01, "fit");
  bound("thermal radiance against LOWTRAN 7 in its own layers, upwards and sky", most[1], 0.01, "fit; its layers' mean temperature");
  bound("thermal radiance against LOWTRAN 7 in its own layers, downwards", most[2], 0.01, "fit; its layers' mean temperature");
  bound("the same upwards, layers thin: what LOWTRAN's 1 km layers cost it", thin, 0.085, "6-7 % in 3-5 um is LOWTRAN's");
}

TEST_F(Reference, SunAtTheGround) {
  const auto sun = rows("solar_direct_us76_rural23.csv");
  double most = 0.0;
  size_t column = 3;
  for (double zenith : {0.0, 30.0, 45.0, 60.0, 75.0}) {
    const AbsorberAmounts w = slant(zenith, 100.0);
    for (const auto& [low, high] : {std::pair{0.4, 0.7}, std::pair{0.7, 2.5}, std::pair{3.0, 5.0}}) {
      double mine = 0.0, lowtran = 0.0;
      for (const auto& row : sun) {
        if (row[1] < low || row[1] > high) continue;
        mine += row[1] * row[1] * row[2] * standardAir().transmittance(1e4 / row[0], w);
        lowtran += row[1] * row[1] * row[column];
      }
      most = std::max(most, std::abs(mine / lowtran - 1.0));
    }
    ++column;
  }
  bound("direct sun at the ground against LOWTRAN 7, 0.4-0.7, 0.7-2.5, 3-5 um, relative", most, 0.005, "fit; its own sun above the air; straight path");
}

// ---- Files ---------------------------------------------------------------------------------------------------------------------------------

TEST(AbsorberTable, ShippedFilesSayWhatTheyAre) {
  for (const AbsorberTable* air : {&standardAir(), &summerAir()}) {
    EXPECT_NE(air->source().find("LOWTRAN 7"), std::string::npos);
    EXPECT_EQ(air->absorbers().size(), 12u);
    EXPECT_NEAR(air->validLow_um(), 0.4, 1e-12);
    EXPECT_NEAR(air->validHigh_um(), 1e4 / 700.0, 1e-12);
    EXPECT_NO_THROW(air->coefficients(air->validLow_um()));
    EXPECT_NO_THROW(air->coefficients(air->validHigh_um()));
    EXPECT_THROW(air->coefficients(0.39), OutsideSpectrum);
    EXPECT_THROW(air->coefficients(14.3), OutsideSpectrum);
    EXPECT_GT(air->hazeAlbedo(1.0), 0.8);
  }
}

TEST(AbsorberTable, BrokenFilesSayWhere) {
  const auto message = [](const std::string& text) -> std::string {
    std::istringstream in(text);
    try {
      AbsorberTable::read(in, "f.air");
    } catch (const UserError& e) {
      return e.what();
    }
    return "no error";
  };
  const std::string head = "pitviper-air 1\namount a 0.5 gas\n", levels = "level 0 300 1\nlevel 9000 220 0\n", bins = "bin 800 0 1\nbin 900 0 1\n";
  EXPECT_EQ(message(head + levels + bins), "no error");
  EXPECT_EQ(message(head + "level 0 300 1 # a comment\n\n# another\nlevel 9000 220 0\r\n" + bins), "no error");
  const std::map<std::string, std::string> broken = {
      {"", "f.air:1:1: the file is empty"},
      {"pitviper-air 2\n", "f.air:1:1: not an air table"},
      {"\n  hello\n", "f.air:2:3: not an air table"},
      {"pitviper-air 1\namount a 0.5\n", "f.air:2:10: 'amount' with 2 values; expected 3"},
      {"pitviper-air 1\namount a 1.5 gas\n", "f.air:2:10: exponent is '1.5'; expected a number from 0.1 to 1"},
      {"pitviper-air 1\namount a 0.5 smoke\n", "f.air:2:14: kind 'smoke'"},
      {"pitviper-air 1\namount a 0.5 gas steam\n", "f.air:2:18: law 'steam'"},
      {"pitviper-air 1\namount a 0.5 gas water 1\n", "f.air:2:24: 'amount' with 5 values; expected 6"},
      {head + "reference 1013 288 7745 0.03\n", "f.air:3:25: 'reference' with 4 values; expected 5"},
      {head + "carbon_dioxide b 700 900\n", "f.air:3:16: no amount 'b'"},
      {head + "amount a 1 gas\n", "f.air:3:8: amount 'a' twice"},
      {head + "level 0 300 nan\n", "f.air:3:13: density of a is 'nan'"},
      {head + "level 0 300 -1\n", "f.air:3:13: density of a is '-1'"},
      {head + "level 0 300 1 2\n", "f.air:3:15: 'level' with 4 values; expected 3"},
      {head + "level 5 300 1\nlevel 5 300 1\n", "f.air:4:7: altitude '5' [m] is not above"},
      {head + bins, "f.air:3:1: a bin before two levels"},
      {head + levels + "bin 800 0 1\nbin 800 0 1\n", "f.air:6:5: wavenumber '800' is not above"},
      {head + levels + "bin 800 0 1e999\n", "f.air:5:11: coefficient of a is '1e999'"},
      {head + levels + "bin 800 2 1\n", "f.air:5:9: albedo is '2'"},
      {head + levels + "bin 800 0 1\n", "f.air:6:1: fewer than two bins"},
      {head + levels + "tau 1\n", "f.air:5:1: unknown word 'tau'"},
      {head + levels + bins + "level 10000 300 1\n", "f.air:7:1: a level after bins"},
      {head + std::string(5000, 'x'), "f.air:3:1: a line of more than 4096 characters"},
  };
  for (const auto& [text, expected] : broken) EXPECT_EQ(message(text).substr(0, expected.size()), expected) << text;
  EXPECT_THROW(AbsorberTable::read(fs::path("/nonexistent.air")), UserError);
}

}  // namespace
}  // namespace pitviper::test
