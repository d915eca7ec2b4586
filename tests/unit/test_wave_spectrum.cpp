// Waves by their spectrum against growth laws, glitter and closed forms; whitecaps. (Where it goes: tests/unit.)
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "materials/foam.hpp"
#include "sim/scene/wave_spectrum.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"

namespace pitviper::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Energy and height of a sea that has grown to its end.
TEST(WaveSpectrum, FullyDevelopedHeight) {
  for (double wind : {5.0, 10.0, 15.0, 20.0}) {
    const WaveSpectrum s(wind);
    const double g = kWaveGravity_m_s2, energy = s.moments().height_m2 * g * g / std::pow(wind, 4.0);
    figure(print("g^2 variance / U^4, fully developed, %.0f m/s", wind), energy, 3.64e-3, 0.74 / 3.64, "Young 1999: (3.64 +- 0.74)e-3");
    figure(print("g H / U^2, fully developed, %.0f m/s", wind), s.significantHeight_m() * g / (wind * wind), 0.24, 0.1,
           "0.24 (Komen et al. 1984, 4 sqrt(3.64e-3)); peak enhancement of 1.7 adds to Pierson and Moskowitz's");
  }
}

// JONSWAP's growth by fetch, where it was seen: 100 to 3000 x U^2 / g.
TEST(WaveSpectrum, GrowsWithFetch) {
  for (double fetch : {100.0, 300.0, 1000.0, 3000.0}) {
    const double wind = 10.0, g = kWaveGravity_m_s2, age = WaveSpectrum::inverseWaveAgeOf(wind, fetch * wind * wind / g);
    const WaveSpectrum s(wind, age);
    figure(print("g^2 variance / U^4 at a fetch of %.0f U^2 / g", fetch), s.moments().height_m2 * g * g / std::pow(wind, 4.0), 1.6e-7 * fetch, 0.15,
           "Hasselmann et al. 1973: 1.6e-7 x");
    figure(print("peak frequency f U / g at a fetch of %.0f", fetch), waveFrequency_rad_s(s.peak_rad_m()) * wind / (2.0 * kPi * g),
           3.5 * std::pow(fetch, -0.33), 0.13, "Hasselmann et al. 1973: 3.5 x^-0.33");
  }
  EXPECT_NEAR(WaveSpectrum::inverseWaveAgeOf(10.0, 1e7), WaveSpectrum::kFullyDeveloped, 1e-3);
}

// Glitter of a clean sea, and of one whose waves below 30 cm oil took away.
TEST(WaveSpectrum, SlopesAreThoseOfGlitter) {
  for (double wind : {5.0, 7.0, 10.0, 12.0, 14.0}) {
    const WaveSpectrum s(wind);
    // From 10 m to 12.5 m up, by the wind's own profile.
    const double higher = wind + s.frictionVelocity_m_s() / 0.4 * std::log(1.25);
    const WaveMoments all = s.moments(), seen = coxMunkSlopes(higher), dull = s.moments(0.0, 2.0 * kPi / 0.3);
    bound(print("mean square slope, %.0f m/s: %.4f, from Cox and Munk's %.4f", wind, all.slope(), seen.slope()), std::abs(all.slope() - seen.slope()), 0.008,
          "twice the scatter of 0.004");
    bound(print("along the wind, %.0f m/s: %.4f, from %.4f", wind, all.slopeUp, seen.slopeUp), std::abs(all.slopeUp - seen.slopeUp), 0.008, "twice 0.004");
    bound(print("across it, %.0f m/s: %.4f, from %.4f", wind, all.slopeCross, seen.slopeCross), std::abs(all.slopeCross - seen.slopeCross), 0.004,
          "twice 0.002");
    const double slick = 0.008 + 1.56e-3 * higher;
    bound(print("of waves above 0.3 m, %.0f m/s: %.4f, from their slick sea's %.4f", wind, dull.slope(), slick), std::abs(dull.slope() - slick), 0.008,
          "twice the scatter of 0.004; where oil cuts is known to a factor of 1.5");
  }
}

TEST(WaveSpectrum, ClosedForms) {
  figure("the slowest waves' length [cm]", 200.0 * kPi / kSlowestWave_rad_m, 1.7, 0.01, "370 rad/m, Elfouhaily et al. 1997");
  figure("and speed [m/s]", phaseSpeed_m_s(kSlowestWave_rad_m), 0.23, 1e-12, "by definition");
  for (double k : {1.0, 100.0, 3000.0}) {
    EXPECT_GE(phaseSpeed_m_s(k), phaseSpeed_m_s(kSlowestWave_rad_m));
    figure(print("omega of k = %.0f", k), waveFrequency_rad_s(k), k * phaseSpeed_m_s(k), 1e-12, "omega = k c");
  }
  const WaveSpectrum s(10.0);
  figure("peak [rad/m]", s.peak_rad_m(), 0.84 * 0.84 * 9.81 / 100.0, 1e-12, "Omega^2 g / U^2");
  double best = 0.01;
  for (double k = 0.01; k < 1.0; k *= 1.001)
    if (s.omnidirectional(k) > s.omnidirectional(best)) best = k;
  figure("where S is highest", best, s.peak_rad_m(), 0.03, "the peak; exp(-Omega / sqrt(10) (sqrt(k / k_p) - 1)) moves it by 2 %");
  double all = 0.0, along = 0.0;
  constexpr int kTurns = 64;
  for (int i = 0; i < kTurns; ++i) {
    const double phi = 2.0 * kPi * i / kTurns, psi = s.directional(3.0, phi) * 3.0 * 2.0 * kPi / kTurns;
    all += psi;
    along += psi * std::cos(phi) * std::cos(phi);
  }
  figure("Psi k over all directions", all, s.omnidirectional(3.0), 1e-12, "S");
  figure("cos^2 over them", along / all, 0.5 * (1.0 + 0.5 * s.spread(3.0)), 1e-12, "(1 + Delta / 2) / 2");
}

// A picture's waves and those left to statistics add up.
TEST(WaveSpectrum, MomentsAddUp) {
  const WaveSpectrum s(8.0);
  const WaveMoments all = s.moments();
  for (double cut : {0.05, 0.7, 20.0, 500.0}) {
    const WaveMoments low = s.moments(0.0, cut), high = s.moments(cut, WaveSpectrum::kShortest_rad_m);
    figure(print("height's variance, cut at %g rad/m", cut), low.height_m2 + high.height_m2, all.height_m2, 1e-6, "additive");
    figure(print("slopes along the wind, cut at %g rad/m", cut), low.slopeUp + high.slopeUp, all.slopeUp, 1e-6, "additive");
    figure(print("slopes across it, cut at %g rad/m", cut), low.slopeCross + high.slopeCross, all.slopeCross, 1e-6, "additive");
  }
  EXPECT_EQ(s.moments(2.0, 1.0).slope(), 0.0);
  EXPECT_EQ(WaveSpectrum(0.0).moments().height_m2, 0.0);
}

TEST(WaveSpectrum, MistakesAreRefused) {
  EXPECT_THROW(WaveSpectrum(-1.0), std::invalid_argument);
  EXPECT_THROW(WaveSpectrum(41.0), std::invalid_argument);
  EXPECT_THROW(WaveSpectrum(std::nan("")), std::invalid_argument);
  EXPECT_THROW(WaveSpectrum(10.0, 0.5), std::invalid_argument);
  EXPECT_THROW(WaveSpectrum(10.0, 6.0), std::invalid_argument);
  EXPECT_THROW(WaveSpectrum::inverseWaveAgeOf(0.0, 1e3), std::invalid_argument);
}

TEST(Foam, CoverAndReflectance) {
  figure("whitecaps at 10 m/s", whitecapShare(10.0), 0.00987, 1e-3, "3.84e-6 x 10^3.41");
  EXPECT_EQ(whitecapShare(0.0), 0.0);
  EXPECT_LE(whitecapShare(60.0), 1.0);
  for (double um : {0.44, 0.85, 1.02, 1.65})
    figure(print("foam's reflectance at %.2f um over that at 0.44", um), foamReflectance(um) / foamReflectance(0.44),
           um < 0.5   ? 1.0
           : um < 0.9 ? 0.6
           : um < 1.1 ? 0.5
                      : 0.15,
           1e-12, "Frouin et al. 1996");
  for (double um = 0.3; um < 14.0; um += 0.05) EXPECT_GE(foamReflectance(um), foamReflectance(um + 0.05));
}

}  // namespace
}  // namespace pitviper::test
