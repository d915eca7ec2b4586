// Black bodies and bands in arrays, against closed forms and published tables.
#include <gtest/gtest.h>

#include <cmath>

#include "scenarios/session/band_physics.hpp"
#include "sim/parameters/error.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

using Values = std::vector<double>;

// All of what a black body sends: pi L = sigma T^4; photons: pi L = 4 pi zeta(3) k^3 / (h^3 c^2) T^3. Over thirteen octaves at once.
TEST(BandPhysics, AllOfABlackBody) {
  const Responsivity all(0.1, 1000.0);
  const double kelvin = 3000.0, zeta3 = 1.2020569031595942, x = kSecondRadiation_umK / 1e3 / kelvin;
  // Beyond 1000 um: 15 / pi^4 x^3 / 3 of it, x = c2 / (1000 um T) = 0.005: 6e-9. Of photons x^2 / (4 zeta(3)), and x^3 / 6 of that series.
  figure("radiance of all wavelengths at 3000 K [W/(m2 sr)]", bandRadiance(Values{kelvin}, all)[0], kStefanBoltzmann * std::pow(kelvin, 4) / kPi, 1e-8,
         "sigma T^4 / pi less what lies beyond 1000 um");
  const double photons = 4.0 * zeta3 * std::pow(kBoltzmann / kPlanckConstant, 3) / (kLightSpeed * kLightSpeed) * std::pow(kelvin, 3);
  figure("photon radiance of all wavelengths at 3000 K [photon/(s m2 sr)]", bandRadiance(Values{kelvin}, all, LightUnit::Photons)[0],
         photons * (1.0 - x * x / (4.0 * zeta3)), 2e-8, "4 zeta(3) k^3 / (h^3 c^2) T^3 less what lies beyond 1000 um");
  figure("slope of the radiance of all wavelengths at 3000 K [W/(m2 sr K)]", bandRadianceSlope(Values{kelvin}, all)[0],
         4.0 * kStefanBoltzmann * std::pow(kelvin, 3) / kPi, 1e-7, "4 sigma T^3 / pi");
}

// Share of a black body's light below a wavelength: Howell, Menguc and Siegel, Thermal Radiation Heat Transfer, and Incropera, table 12.1, all digits.
TEST(BandPhysics, PublishedShares) {
  const double kelvin = 1000.0, all = kStefanBoltzmann * std::pow(kelvin, 4) / kPi;
  const std::pair<double, double> kShares[] = {{2.0, 0.066728}, {3.0, 0.273232}, {4.0, 0.480877}, {5.0, 0.633747}, {6.0, 0.737818}};
  // Those tables were made with constants of their time, some 1e-5 from today's.
  for (const auto& [um, share] : kShares) EXPECT_NEAR(bandRadiance(Values{kelvin}, {0.1, um})[0] / all, share, 4e-5) << um;
}

// At 300 K by the series of another hand (blackBodyBand): 3-5, 8-12 and 7.5-14 um.
TEST(BandPhysics, BandsAt300K) {
  for (const auto& [low, high] : {std::pair{3.0, 5.0}, std::pair{8.0, 12.0}, std::pair{7.5, 14.0}})
    figure("black body of 300 K, " + print("%g-%g um", low, high) + " [W/(m2 sr)]", bandRadiance(Values{300.0}, {low, high})[0],
           blackBodyBand(low, high, 300.0), 1e-10, "series of the classical integral");
}

// Where it is brightest: 2897.771955 um K per W, 3669.703085 um K in photons (CODATA 2018).
TEST(BandPhysics, WiensLaw) {
  for (const auto& [unit, law] : {std::pair{LightUnit::Watts, 2897.771955}, std::pair{LightUnit::Photons, 3669.703085}}) {
    for (const double kelvin : {300.0, 5772.0}) {
      // The slope is even about the peak: the parabola through three places has its top within their distance squared of it.
      const double at = law / kelvin, step = 1e-4 * at;
      const Values um{at - step, at, at + step}, b = planckRadiance(um, Values{kelvin}, unit);
      const double top = at + 0.5 * step * (b[0] - b[2]) / (b[0] - 2.0 * b[1] + b[2]);
      EXPECT_NEAR(top * kelvin / law, 1.0, 1e-7) << kelvin;
    }
  }
}

TEST(BandPhysics, SpectraAndTheirSlopes) {
  const Values um{0.55, 4.0, 10.0, 900.0}, kelvin{0.0, 1e-12, 250.0, 300.0, 3000.0};
  const Values b = planckRadiance(um, kelvin), slope = planckSlope(um, kelvin), photons = planckRadiance(um, kelvin, LightUnit::Photons);
  ASSERT_EQ(b.size(), um.size() * kelvin.size());
  for (std::size_t i = 0; i < 2 * um.size(); ++i) EXPECT_EQ(b[i], 0.0) << i;
  for (std::size_t t = 2; t < kelvin.size(); ++t)
    for (std::size_t i = 0; i < um.size(); ++i) {
      const std::size_t k = t * um.size() + i;
      // Written out with the library's own functions.
      const double x = kSecondRadiation_umK / (um[i] * kelvin[t]), expected = kFirstRadianceConstant / std::pow(um[i], 5) / std::expm1(x);
      EXPECT_NEAR(b[k] / expected, 1.0, 1e-11) << um[i] << " um, " << kelvin[t] << " K";
      EXPECT_NEAR(slope[k] / (expected * x / (kelvin[t] * -std::expm1(-x))), 1.0, 1e-11) << um[i] << " um, " << kelvin[t] << " K";
      // A photon has h c / lambda.
      EXPECT_NEAR(photons[k] * kPlanckConstant * kLightSpeed / (um[i] * 1e-6) / b[k], 1.0, 1e-14);
    }
}

// The inverse gives back what it is an inverse of; the step of Newton's is worth a thousand times (the table alone is off by 1e-5).
TEST(BandPhysics, ApparentTemperatures) {
  const Values um{3.3, 3.6, 4.0, 4.4, 5.0}, response{0.0, 0.7, 1.0, 0.8, 0.0}, kelvin{60.0, 251.3, 300.0, 305.0, 1000.0, 2896.0, 15000.0};
  for (const Responsivity& band : {Responsivity(um, response), Responsivity(8.0, 12.0)})
    for (const LightUnit unit : {LightUnit::Watts, LightUnit::Photons}) {
      const Values back = apparentTemperature(bandRadiance(kelvin, band, unit), band, unit);
      for (std::size_t i = 0; i < kelvin.size(); ++i) EXPECT_NEAR(back[i] / kelvin[i], 1.0, 1e-8) << kelvin[i];
    }
  const Responsivity band(8.0, 12.0);
  EXPECT_EQ(apparentTemperature(Values{0.0}, band)[0], 0.0);
  EXPECT_EQ(apparentTemperature(Values{1e9}, band)[0], 20000.0);
}

// Slopes against differences of what they are slopes of.
TEST(BandPhysics, SlopesOfBands) {
  const Responsivity band(3.0, 5.0);
  for (const LightUnit unit : {LightUnit::Watts, LightUnit::Photons}) {
    const Values at = bandRadiance(Values{299.9, 300.1}, band, unit);
    // (x 0.1 / 300)^2 / 6 of the third derivative, x = 12.
    EXPECT_NEAR(bandRadianceSlope(Values{300.0}, band, unit)[0] / ((at[1] - at[0]) / 0.2), 1.0, 1e-5);
  }
}

// Tables that are lines between their wavelengths: products are parabolas, whose integrals are closed.
TEST(BandPhysics, IntegralsOfTables) {
  const Values um{3.0, 5.0}, rising{3.0, 5.0};
  EXPECT_NEAR(bandIntegral(um, rising), 8.0, 1e-12);
  // A triangle of height 1 over 3 to 5 um, times the wavelength: its area times its middle.
  const Responsivity triangle(Values{3.0, 4.0, 5.0}, Values{0.0, 1.0, 0.0});
  EXPECT_NEAR(bandIntegral(um, rising, triangle), 4.0, 1e-12);
  EXPECT_NEAR(bandMean(um, rising, triangle), 4.0, 1e-12);
  // Bends of their own: |lambda - 3.5| on the triangle. From 3 to 3.5: int (0.5 - u) u = 1/48; 3.5 to 4: int v (0.5 + v) = 5/48; 4 to 5: int (0.5 + w) (1 - w)
  // = 5/12.
  EXPECT_NEAR(bandIntegral(Values{2.0, 3.5, 6.0}, Values{1.5, 0.0, 2.5}, triangle), 1.0 / 48.0 + 5.0 / 48.0 + 5.0 / 12.0, 1e-12);
  // A step in the middle, and a flat band that cuts a table: 2 from 3.2 to 4, 10 from 4 to 4.4.
  EXPECT_NEAR(bandIntegral(Values{3.0, 4.0, 4.0, 5.0}, Values{2.0, 2.0, 10.0, 10.0}, {3.2, 4.4}), 1.6 + 4.0, 1e-12);
  EXPECT_NEAR(bandMean(Values{3.0, 4.0, 4.0, 5.0}, Values{-2.0, -2.0, 10.0, 10.0}, {3.2, 4.4}), (4.0 - 1.6) / 1.2, 1e-12);
}

TEST(BandPhysics, WhatIsRefused) {
  const Values um{3.0, 4.0}, two{1.0, 1.0};
  const Responsivity band(3.0, 4.0);
  const auto why = [](const auto& call, const char* part) {
    const std::string said = refusalOf(call);
    EXPECT_TRUE(holds(said, part)) << "'" << said << "' has not '" << part << "'";
  };
  why([&] { planckRadiance(Values{3.0, NAN}, two); }, "planck_radiance(): wavelength_um[1] is nan; expected 0.1 to 1000 um");
  why([&] { planckRadiance(Values{-3.0}, two); }, "wavelength_um[0] is -3");
  why([&] { planckRadiance(Values{2000.0}, two); }, "wavelength_um[0] is 2000");
  why([&] { planckSlope(um, Values{300.0, -1.0}); }, "planck_slope(): temperature_K[1] is -1; expected 0 or more");
  why([&] { bandRadiance(Values{INFINITY}, band); }, "band_radiance(): temperature_K[0] is inf");
  why([&] { bandRadianceSlope(Values{NAN}, band); }, "band_radiance_slope(): temperature_K[0] is nan");
  why([&] { apparentTemperature(Values{1.0, -1e-9}, band); }, "apparent_temperature(): radiance[1] is -1e-09");
  why([&] { bandIntegral(um, Values{1.0}); }, "band_integral(): values has 1 entries; expected 2, one for each wavelength");
  why([&] { bandIntegral(um, Values{1.0, NAN}); }, "values[1] is nan");
  why([&] { bandIntegral(Values{4.0, 3.0}, two); }, "wavelength_um[1] is 3; expected more than the 4 before it");
  why([&] { bandIntegral(Values{3.0, 4.0, 4.0, 4.0}, Values{1.0, 1.0, 1.0, 1.0}); }, "wavelength_um[3] is 4");
  why([&] { bandIntegral(Values{3.0}, Values{1.0}); }, "wavelength_um has 1 entry");
  why([&] { bandIntegral(Values{3.0, 3.0}, two); }, "is one wavelength");
  why([&] { bandIntegral(um, two, {2.9, 3.5}); }, "the responsivity reaches from 2.9 to 3.5 um, the values from 3 to 4 um");
  why([&] { bandMean(um, two, {3.5, 4.1}); }, "band_mean(): the responsivity reaches");
  why([&] { Responsivity(5.0, 3.0); }, "responsivity(): band_um[1] is 3");
  why([&] { Responsivity(um, Values{1.0, -0.1}); }, "responsivity(): value[1] is -0.1");
  why([&] { Responsivity(um, Values{0.0, 0.0}); }, "0 throughout");
  why([&] { Responsivity(Spectrum(Spectrum::Table{{3.0, 4.0}, {1.0, 1.0}, Outside::Error, "t"})); }, "data from 3 to 4 um that reaches");
}

}  // namespace
}  // namespace pitviper::test
