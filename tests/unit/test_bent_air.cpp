// Layered air whose lines bend: straight where nothing bends, Bouguer's law integrated finely, published air masses, from either end the same.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "atmosphere/bent_path.hpp"
#include "atmosphere/layered.hpp"
#include "sim/model/refracts.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/world/sun_legs.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

constexpr double kEarth_m = 6371000.0, kVisible = 0.574;

const AbsorberTable& standardTable() {
  static const AbsorberTable table = AbsorberTable::read(std::filesystem::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/us76_rural.air");
  return table;
}

AbsorberTable bentTable(double coefficient) {
  AbsorberTable table = standardTable();
  EXPECT_TRUE(table.setRefraction(airRefractivity(kVisible), coefficient));
  return table;
}

double sineOf(double degrees) { return std::sin(degrees * kPi / 180.0); }

size_t molecules() {
  size_t k = 0;
  while (standardTable().absorbers()[k].kind != AbsorberKind::Scattering) ++k;
  return k;
}

/// Largest relative difference of what both hold of the absorbers that the second holds.
double apart(const AbsorberAmounts& a, const AbsorberAmounts& b) {
  double worst = 0.0;
  for (size_t k = 0; k < standardTable().absorbers().size(); ++k)
    if (b.amount_km[k] > 1e-9) worst = std::max(worst, std::abs(a.amount_km[k] / b.amount_km[k] - 1.0));
  return worst;
}

TEST(BentAir, NothingBendsWithoutRefractivity) {
  AbsorberTable table = standardTable();
  ASSERT_TRUE(table.setRefraction(0.0, 0.0));
  double worst = 0.0;
  for (double h : {-100.0, 0.0, 1500.0, 11000.0, 150000.0})
    for (double e : {-0.15, -0.04, 0.0, 1e-4, 0.03, 0.3, 1.0})
      for (double r : {100.0, 2e4, 1e6, double(INFINITY)})
        worst = std::max(worst, apart(table.amounts(h, e, r, kEarth_m), standardTable().amounts(h, e, r, kEarth_m)));
  bound("bent lines that do not bend against straight ones, amounts, relative", worst, 1e-9, "rounding");
}

TEST(BentAir, AirMassIsKastenAndYoungs) {
  const double k = *standardTable().refractionCoefficient(airRefractivity(kVisible), 0.0);
  const AbsorberTable table = bentTable(k);
  const size_t air = molecules();
  const double vertical = table.amounts(0.0, 1.0, INFINITY, kEarth_m / (1.0 - k)).amount_km[air];
  double worst = 0.0;
  // Relative air mass by apparent elevation e in degrees: 1 / (sin e + 0.50572 (e + 6.07995)^-1.6364).
  for (double e : {0.0, 0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 80.0, 90.0}) {
    const double mass = table.amounts(0.0, sineOf(e), INFINITY, kEarth_m / (1.0 - k)).amount_km[air] / vertical;
    worst = std::max(worst, std::abs(mass * (sineOf(e) + 0.50572 * std::pow(e + 6.07995, -1.6364)) - 1.0));
    if (e == 0.0) figure("air mass on the horizon", mass, 37.92, 0.01, "Kasten and Young 1989; their profile is ISO's standard air");
  }
  bound("air mass at 0 to 90 degrees against Kasten and Young 1989, relative", worst, 0.01, "their fit 0.5 %; the profile");
}

TEST(BentAir, IsBouguersLawWhateverTheRadius) {
  double worst = 0.0;
  for (double k : {0.0, 0.163, 0.3}) {
    const AbsorberTable table = bentTable(k);
    for (double h : {0.0, 10.0, 1000.0, 10000.0, 25000.0})
      for (double e : {-2.0, -1.0, -0.3, 0.0, 0.1, 0.5, 2.0, 10.0, 90.0}) {
        const BentPath fine = bentPath(standardTable(), airRefractivity(kVisible), h, sineOf(e), kEarth_m);
        if (!fine.endsAtGround) worst = std::max(worst, apart(table.amounts(h, sineOf(e), INFINITY, kEarth_m / (1.0 - k)), fine.stations.back().amounts));
      }
  }
  bound("bent lines towards space against Bouguer's law integrated finely, amounts, relative", worst, 0.004, "n even over 1 km: haze and water 0.3 %");
}

TEST(BentAir, LimbsFromSpaceGoLower) {
  // The radius stays the real one for eyes that high.
  const AbsorberTable table = bentTable(0.0);
  for (double tangent_km : {8.0, 12.0, 20.0}) {
    const double r0 = kEarth_m + 400000.0, sine = -std::sqrt(1.0 - std::pow((kEarth_m + 1e3 * tangent_km) / r0, 2));
    const BentPath fine = bentPath(standardTable(), airRefractivity(kVisible), 400000.0, sine, kEarth_m);
    const AbsorberAmounts bent = table.amounts(400000.0, sine, INFINITY, kEarth_m), straight = standardTable().amounts(400000.0, sine, INFINITY, kEarth_m);
    const size_t air = molecules();
    figure("air on a limb path past " + std::to_string(static_cast<int>(tangent_km)) + " km [km]", bent.amount_km[air],
           fine.stations.back().amounts.amount_km[air], 0.005, "Bouguer's law integrated finely");
    EXPECT_GT(bent.amount_km[air], straight.amount_km[air]);
  }
}

TEST(BentAir, IsTheSameFromEitherEndAndAdds) {
  constexpr double k = 0.163;
  const AbsorberTable table = bentTable(k);
  const double radius = kEarth_m / (1.0 - k), perDensity = *table.refractivityPerDensity(airRefractivity(kVisible));
  const auto nr = [&](double h) { return (1.0 + perDensity * table.airDensity(h)) * (kEarth_m + h); };
  double worst = 0.0, sum = 0.0;
  for (double e : {-0.8, -0.1, 0.0, 0.5, 3.0, 40.0}) {
    const double sine = sineOf(e);
    for (const PathStation& s : table.stations(3000.0, sine, INFINITY, radius)) {
      // At levels, where densities and bends are the same numbers.
      const double level = std::round(s.height_m / 1000.0) * 1000.0;
      if (std::abs(s.height_m - level) > 1e-6 || level > 20000.0 || s.range_m < 100.0) continue;
      const double cosine = nr(3000.0) * std::sqrt(1.0 - sine * sine) / nr(level),
                   before = table.stationsAt(3000.0, sine, std::vector{0.0, s.range_m - 1.0}, radius).back().height_m;
      const double there = std::copysign(std::sqrt(std::max(1.0 - cosine * cosine, 0.0)), s.height_m - before);
      worst = std::max(worst, apart(table.amounts(level, -there, s.range_m, radius), table.amounts(3000.0, sine, s.range_m, radius)));
      sum = std::max(sum, apart(table.amounts(3000.0, sine, s.range_m, radius) + table.amounts(level, there, INFINITY, radius),
                                table.amounts(3000.0, sine, INFINITY, radius)));
    }
  }
  bound("bent lines from either end, amounts, relative", worst, 1e-7, "rounding of the other end's elevation");
  bound("two parts of a bent line against the whole, amounts, relative", sum, 1e-5, "quadrature");
}

TEST(BentAir, StationsAgreeWithAmounts) {
  const AbsorberTable table = bentTable(0.163);
  const double radius = kEarth_m / (1.0 - 0.163);
  std::vector<double> ranges = {0.0, 100.0, 5e3, 2e4, 8e4, 2e5, 5e5, 1e7};
  for (double e : {-0.3, 0.0, 2.0}) {
    const auto at = table.stationsAt(2000.0, sineOf(e), ranges, radius);
    ASSERT_EQ(at.size(), ranges.size());
    for (size_t i = 1; i + 1 < ranges.size(); ++i) {
      EXPECT_EQ(at[i].range_m, ranges[i]);
      EXPECT_LT(apart(at[i].amounts, table.amounts(2000.0, sineOf(e), ranges[i], radius)), 2e-4) << e << " " << ranges[i];
    }
    const auto places = table.placesAlong(2000.0, sineOf(e), 3e4, radius);
    EXPECT_EQ(places.front(), 0.0);
    EXPECT_NEAR(places.back(), 3e4, 1e-6);
    EXPECT_LE(places.back(), 3e4);
  }
}

TEST(BentAir, SunsBelowTheLevelShineThroughWhatBends) {
  const auto straight = makeLayeredAir(standardTable());
  double worst = 0.0;
  for (double k : {0.0, 0.163}) {
    const auto air = dynamic_cast<const Refracts&>(*straight).bent(k);
    ASSERT_TRUE(air);
    const double radius = kEarth_m / (1.0 - k);
    for (double h : {300.0, 1000.0, 10000.0, 15000.0})
      for (double e : {-0.3, -0.6, -1.0, -2.0}) {
        const double sine = sineOf(e);
        if (h < (radius + h) * 0.6 * sine * sine) continue;  // the earth is in the way
        const auto way = SunLegs(air, sine, radius).at(h, sine), exact = air->amounts({h, sine, radius}, physics::kFar);
        for (size_t a = 0; a < standardTable().absorbers().size(); ++a)
          if (exact.amount[a] > 1e-3) worst = std::max(worst, std::abs(way.amount[a] / exact.amount[a] - 1.0));
      }
  }
  bound("tabulated ways to a sun below the level through air that bends, amounts, relative", worst, 0.005, "tables by height; straight ones alike");
}

TEST(BentAir, HighElevationsAreAsBefore) {
  const double k = 0.163;
  const AbsorberTable table = bentTable(k);
  double worst = 0.0, air = 0.0;
  for (double h : {0.0, 2000.0, 10000.0})
    for (double e : {10.0, 15.0, 30.0, 60.0, 90.0}) {
      const AbsorberAmounts bent = table.amounts(h, sineOf(e), INFINITY, kEarth_m / (1.0 - k)),
                            straight = standardTable().amounts(h, sineOf(e), INFINITY, kEarth_m);
      worst = std::max(worst, apart(bent, straight));
      air = std::max(air, std::abs(bent.amount_km[molecules()] / straight.amount_km[molecules()] - 1.0));
    }
  bound("air on bent against straight lines from 10 degrees up, relative", air, 0.005, "0.36 % at 10 degrees, as LOWTRAN has it");
  bound("the same of any absorber", worst, 0.007, "ozone, which lies above most of the bend: 0.64 % at 10 degrees");
}

TEST(BentAir, WhatCannotBendIsLeft) {
  std::istringstream bare("pitviper-air 1\namount a 1 gas\nlevel 0 300 1\nlevel 1000 300 1\nbin 800 0 1\nbin 900 0 1\n");
  AbsorberTable table = AbsorberTable::read(bare, "made");
  EXPECT_FALSE(table.setRefraction(airRefractivity(kVisible), 0.0));
  EXPECT_FALSE(table.refractionCoefficient(airRefractivity(kVisible), 0.0));
  // A third of the density lost in 500 m: a duct.
  std::istringstream duct("pitviper-air 1\namount a 1 scattering\nlevel 0 300 1\nlevel 500 300 0.7\nlevel 30000 300 0.01\nbin 800 0 1\nbin 900 0 1\n");
  AbsorberTable ducting = AbsorberTable::read(duct, "made");
  const double before = ducting.amounts(0.0, 0.0, INFINITY, kEarth_m).amount_km[0];
  EXPECT_GT(*ducting.refractionCoefficient(airRefractivity(kVisible), 0.0), 0.5);
  EXPECT_FALSE(ducting.setRefraction(airRefractivity(kVisible), 0.0));
  EXPECT_EQ(ducting.amounts(0.0, 0.0, INFINITY, kEarth_m).amount_km[0], before);
}

}  // namespace
}  // namespace pitviper::test
