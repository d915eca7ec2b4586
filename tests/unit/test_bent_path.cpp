// Paths bent by refraction: straight ones where nothing bends, closed forms, astronomers' refraction, LOWTRAN's geometry.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "atmosphere/bent_path.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

constexpr double kEarth_m = 6371230.0;

const AbsorberTable& standardAir() {
  static const AbsorberTable table = AbsorberTable::read(fs::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/us76_rural.air");
  return table;
}

double degrees(double d) { return d * kPi / 180.0; }

TEST(BentPath, RefractivityIsEdlens) {
  // Edlen 1966, standard air: n - 1 = 2.7782e-4 at 0.55 um; 2.7637e-4 at 0.6438 um.
  EXPECT_NEAR(airRefractivity(0.55), 2.7782e-4, 2e-8);
  EXPECT_NEAR(airRefractivity(0.6438), 2.7637e-4, 3e-8);
  EXPECT_NEAR(airRefractivity(10.0), 2.726e-4, 2e-7);
}

TEST(BentPath, NothingBendsWithoutRefractivity) {
  double worst = 0.0;
  for (double h : {0.0, 1500.0, 11000.0, 150000.0})
    for (double e : {-0.15, -0.04, 0.0, 1e-4, 0.03, 0.3, 1.0}) {
      const BentPath bent = bentPath(standardAir(), 0.0, h, e, kEarth_m);
      EXPECT_NEAR(bent.bending_rad, 0.0, 1e-7) << h << " " << e;
      const auto& end = bent.stations.back();
      const AbsorberAmounts straight = standardAir().amounts(h, e, bent.endsAtGround ? end.range_m : INFINITY, kEarth_m);
      for (size_t k = 0; k < standardAir().absorbers().size(); ++k)
        if (straight.amount_km[k] > 1e-6) worst = std::max(worst, std::abs(end.amounts.amount_km[k] / straight.amount_km[k] - 1.0));
    }
  bound("bent paths that do not bend against straight ones, amounts, relative", worst, 1e-5, "two quadratures");
}

TEST(BentPath, BendsAsAstronomersSay) {
  const double n = airRefractivity(0.574);
  const auto bending = [&](double elevation_deg) {
    return bentPath(standardAir(), n, 0.0, std::sin(degrees(elevation_deg)), kEarth_m).bending_rad * 180.0 / kPi * 60.0;
  };
  // Laplace: N (1 - b) tan z - N (b - N/2) tan^3 z, b the height of even air over the earth's radius; whatever the profile. Next term: 7e-4 at 70 degrees.
  const double N = *standardAir().refractivityPerDensity(n) * standardAir().airDensity(0.0);
  const AbsorberAmounts column = standardAir().amounts(0.0, 1.0, INFINITY, kEarth_m);
  size_t air = 0;
  while (standardAir().absorbers()[air].kind != AbsorberKind::Scattering) ++air;
  const double b = 1e3 * column.amount_km[air] / kEarth_m;
  for (double z : {45.0, 70.0}) {
    const double t = std::tan(degrees(z));
    figure("refraction at a zenith angle of " + std::to_string(static_cast<int>(z)) + " [arc minutes]", bending(90.0 - z),
           N * t * ((1.0 - b) - (b - 0.5 * N) * t * t) * 180.0 / kPi * 60.0, z == 45.0 ? 1e-4 : 1e-3, "Laplace");
  }
  // Bennett 1982 (J. Navigation 35, 255): cot(e + 7.31 / (e + 4.4)) arc minutes, 1010 hPa and 10 C; to 15 C and 1013 hPa by density: 0.985.
  for (double e : {0.0, 1.0, 5.0})
    figure("refraction at " + std::to_string(static_cast<int>(e)) + " degrees [arc minutes]", bending(e), 0.985 / std::tan(degrees(e + 7.31 / (e + 4.4))),
           e == 0.0 ? 0.05 : 0.025, "Bennett 1982, 0.07 arc minutes; profile of the air");
}

TEST(BentPath, TheInvariantHoldsAndPathsAreReversible) {
  const double n = airRefractivity(1.0);
  // Up from 2 km at 3 degrees, and down from its end: the same path.
  const BentPath up = bentPath(standardAir(), n, 2000.0, std::sin(degrees(3.0)), kEarth_m, 30000.0);
  const BentPath down = bentPath(standardAir(), n, 30000.0, -up.sinElevationAtEnd, kEarth_m);
  ASSERT_TRUE(down.endsAtGround);
  const BentPath whole = bentPath(standardAir(), n, 0.0, -down.sinElevationAtEnd, kEarth_m, 30000.0);
  EXPECT_NEAR(whole.stations.back().range_m / down.stations.back().range_m, 1.0, 1e-6);
  EXPECT_NEAR(whole.bending_rad, down.bending_rad, 1e-6);
  EXPECT_NEAR(whole.sinElevationAtEnd, up.sinElevationAtEnd, 1e-9);
  // A limb path bends twice what half of it does.
  const BentPath limb = bentPath(standardAir(), n, 40000.0, -std::sqrt(1.0 - std::pow((kEarth_m + 12000.0) / (kEarth_m + 40000.0), 2)), kEarth_m);
  ASSERT_FALSE(limb.endsAtGround);
  double lowest = 1e9;
  for (const PathStation& s : limb.stations) lowest = std::min(lowest, s.height_m);
  EXPECT_LT(lowest, 12000.0);  // below the straight line's
  EXPECT_GT(lowest, 11000.0);
  const BentPath half = bentPath(standardAir(), n, lowest, 0.0, kEarth_m);
  const BentPath entered = bentPath(standardAir(), n, 200000.0, -std::sqrt(1.0 - std::pow((kEarth_m + 13000.0) / (kEarth_m + 200000.0), 2)), kEarth_m);
  EXPECT_GT(limb.bending_rad, half.bending_rad);
  EXPECT_GT(entered.bending_rad, 0.0);
  // It leaves the air as it came in.
  EXPECT_NEAR(entered.sinElevationAtEnd, std::sqrt(1.0 - std::pow((kEarth_m + 13000.0) / (kEarth_m + standardAir().top_m()), 2)), 1e-6);
}

TEST(BentPath, WhatCannotBeIsRefused) {
  EXPECT_THROW(bentPath(standardAir(), 3e-4, 5000.0, 0.1, kEarth_m, 1000.0), std::invalid_argument);
  std::istringstream in("pitviper-air 1\namount a 1 gas\nlevel 0 300 1\nlevel 1000 300 1\nbin 800 0 1\nbin 900 0 1\n");
  EXPECT_THROW(bentPath(AbsorberTable::read(in, "made"), 3e-4, 0.0, 0.1, kEarth_m), std::invalid_argument);
  EXPECT_EQ(bentPath(standardAir(), 3e-4, 200000.0, 0.1, kEarth_m).stations.size(), 1u);
}

TEST(BentPath, IsLowtransGeometry) {
  const char* named = std::getenv("PITVIPER_REFERENCE_DATA");
  const auto folder = (named ? fs::path(named) : fs::path(PITVIPER_SOURCE_DIR) / "../shared/data") / "lowtran7";
  if (!fs::exists(folder / "slant_geometry.csv")) GTEST_SKIP() << "no " << folder << "; the reference tables are no part of the project";
  std::ifstream in(folder / "slant_geometry.csv");
  double worstRange = 0.0, worstAngle = 0.0, straightRange = 0.0;
  int rows = 0;
  for (std::string line; std::getline(in, line);) {
    double height = 0.0, ground = 0.0, above = 0.0, range = 0.0;
    if (std::sscanf(line.c_str(), "us76,%lf,%lf,%lf,%lf", &height, &ground, &above, &range) != 4) continue;
    ++rows;
    // LOWTRAN bends at the middle of a run's band; its runs went from 0.4 to 14 um: beyond the visible the index hardly changes.
    const auto ends = [&](double refractivity) { return bentPath(standardAir(), refractivity, 0.0, std::cos(degrees(ground)), kEarth_m, 1e3 * height); };
    const BentPath bent = ends(airRefractivity(1.0)), straight = ends(0.0);
    worstRange = std::max(worstRange, std::abs(1e-3 * bent.stations.back().range_m - range));
    straightRange = std::max(straightRange, std::abs(1e-3 * straight.stations.back().range_m - range));
    worstAngle = std::max(worstAngle, std::abs(180.0 - above - (90.0 - std::asin(bent.sinElevationAtEnd) * 180.0 / kPi)));
  }
  EXPECT_EQ(rows, 12);
  bound("bent paths against LOWTRAN's geometry, range [km]", worstRange, 0.001, "three decimals; its layers");
  bound("the same, zenith angle at the upper end [deg]", worstAngle, 0.001, "three decimals; its layers");
  EXPECT_GT(straightRange, 10.0 * worstRange);  // refraction is seen in the figures
}

TEST(BentPath, SpaceAtEightyDegreesIsLowtrans) {
  const char* named = std::getenv("PITVIPER_REFERENCE_DATA");
  const auto file = (named ? fs::path(named) : fs::path(PITVIPER_SOURCE_DIR) / "../shared/data") / "lowtran7/space_us76_rural23.csv";
  const double sine = std::cos(degrees(80.0));
  const AbsorberAmounts bent = bentPath(standardAir(), airRefractivity(1.0), 0.0, sine, kEarth_m).stations.back().amounts;
  const AbsorberAmounts straight = standardAir().amounts(0.0, sine, INFINITY, kEarth_m);
  size_t rayleigh = 0;
  while (standardAir().absorbers()[rayleigh].kind != AbsorberKind::Scattering) ++rayleigh;
  // Relative air mass by apparent elevation e in degrees: 1 / (sin e + 0.50572 (e + 6.07995)^-1.6364).
  const double vertical = standardAir().amounts(0.0, 1.0, INFINITY, kEarth_m).amount_km[rayleigh];
  figure("air mass at 10 degrees", bent.amount_km[rayleigh] / vertical, 1.0 / (sine + 0.50572 * std::pow(16.07995, -1.6364)), 1e-3, "Kasten and Young 1989");
  std::printf("bent over straight column of air at 80 degrees: %.5f\n", bent.amount_km[rayleigh] / straight.amount_km[rayleigh]);
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file << "; the reference tables are no part of the project";
  std::ifstream in(file);
  double bentMost = 0.0, straightMost = 0.0, bentBias = 0.0, straightBias = 0.0;
  int rows = 0;
  for (std::string line; std::getline(in, line);) {
    double nu = 0.0, um = 0.0, t0 = 0.0, t60 = 0.0, t80 = 0.0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &nu, &um, &t0, &t60, &t80) != 5) continue;
    const double b = standardAir().transmittance(1e4 / nu, bent) - t80, s = standardAir().transmittance(1e4 / nu, straight) - t80;
    bentMost = std::max(bentMost, std::abs(b)), straightMost = std::max(straightMost, std::abs(s));
    bentBias += b, straightBias += s;
    ++rows;
  }
  std::printf("to space at 80 degrees, difference from LOWTRAN: bent worst %.4f mean %.5f, straight worst %.4f mean %.5f\n", bentMost, bentBias / rows,
              straightMost, straightBias / rows);
  bound("bent path to space at 80 degrees against LOWTRAN 7, transmittance", bentMost, 0.005, "fit 0.0043");
}

}  // namespace
}  // namespace pitviper::test
