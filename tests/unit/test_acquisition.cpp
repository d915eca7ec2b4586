// What observers resolve and how far, and spots over noise, against closed forms and by chance.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sensors/acquisition.hpp"
#include "sensors/resolvable.hpp"
#include "sensors/spot_detection.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"

namespace pitviper::test {
namespace {

/// Pixels far finer than anything resolved, of white noise from frame to frame: sigma pitch = `density` [K rad]. No eye's threshold.
Resolving fine(std::function<double(double)> transfer, double density) {
  constexpr double kPitch = 1e-9;
  Resolving c{std::move(transfer), kPitch, kPitch, 512, 50.0, {}, {}};
  c.noise.tvh = density / kPitch;
  c.observer.sceneContrast_K = 0.0;
  return c;
}

/// K rad by which the MRTD of such a camera goes with frequency: (pi^2 / 8) 2.25 sqrt(E_t 2 f (2 f / 7)) = (pi^2 / (4 sqrt 7)) 2.25 f sqrt(E_t).
double slopeOf(double density) { return kPi * kPi / (4.0 * std::sqrt(7.0)) * 2.25 * density / std::sqrt(50.0 * 0.2); }

/// x e^x = y by Newton's steps (Lambert's W), y > 0.
double lambert(double y) {
  double x = std::log1p(y);
  for (int k = 0; k < 60; ++k) x -= (x * std::exp(x) - y) / (std::exp(x) * (1.0 + x));
  return x;
}

// Ratches 1976, as a staring array has it: MRT = pi^2 / (4 sqrt 7) SNR NETD f sqrt(a b) / MTF / sqrt(rate t_eye). 1e-9 rad of pixels against 1 mrad of bars:
// 1e-6.
TEST(Mrtd, FinePixelsByRatches) {
  for (const double density : {5e-6, 2e-5})
    for (const double f : {100.0, 700.0, 3000.0}) {
      const Resolving c = fine([](double u) { return std::exp(-2.0 * kPi * kPi * 1e-4 * 1e-4 * u * u); }, density);
      figure(print("MRTD at %g cycles/mrad, fine pixels [K]", 1e-3 * f), mrtd_K(c, Bars::SideBySide, f),
             slopeOf(density) * f / std::exp(-2.0 * kPi * kPi * 1e-8 * f * f), 1e-5,
             "pi^2 / (4 sqrt 7) 2.25 NETD f sqrt(pitch^2 / (rate t)) / MTF; pitch over a bar, 6e-6");
      EXPECT_EQ(mrtd_K(c, Bars::SideBySide, f), mrtd_K(c, Bars::Stacked, f));
    }
}

// Each component by itself, of pixels of 1/4 of a bar: the ratio to that of all is FLIR92's correction; a bar of 4 pixels by 28 leaves p/w (1 - p/(3w)) of a
// variance.
TEST(Mrtd, NoiseInThreeDimensions) {
  Resolving c{[](double) { return 1.0; }, 1e-3, 1e-3, 480, 30.0, {}, {}};
  c.observer.sceneContrast_K = 0.0;
  const double f = 125.0, a = 0.25 * (1.0 - 0.25 / 3.0), b = (1.0 - 1.0 / 84.0) / 28.0, time = 1.0 / 6.0, shown = std::sin(kPi / 8.0) / (kPi / 8.0),
               whole = kPi * kPi / 8.0 * 2.25 / shown;
  struct Case {
    const char* name;
    double ThermalNoise::*which;
    double across, stacked;  // of the variance
  };
  for (const Case& n : {Case{"tvh", &ThermalNoise::tvh, time * a * b, time * a * b},
                        {"vh", &ThermalNoise::vh, a * b, a * b},
                        {"th", &ThermalNoise::th, time * a, 0.0},
                        {"tv", &ThermalNoise::tv, 0.0, time * a},
                        {"h", &ThermalNoise::h, a, 0.0},
                        {"v", &ThermalNoise::v, 0.0, a}}) {
    c.noise = {};
    c.noise.*n.which = 0.05;
    figure(print("MRTD of sigma_%s, bars side by side [K]", n.name), mrtd_K(c, Bars::SideBySide, f), 0.05 * whole * std::sqrt(n.across), 1e-12,
           "its share of the variance in a bar; rounding");
    figure(print("MRTD of sigma_%s, bars stacked [K]", n.name), mrtd_K(c, Bars::Stacked, f), 0.05 * whole * std::sqrt(n.stacked), 1e-12,
           "its share of the variance in a bar; rounding");
  }
}

// What is left of a pixel's variance in a bar, against the integral of its two squares' spectra over all frequencies.
TEST(Mrtd, NoiseInABarByItsSpectrum) {
  for (const double bar : {0.3, 1.0, 2.5, 9.0}) {  // in pixels
    double sum = 0.0;
    constexpr int kSteps = 400000;
    constexpr double kMost = 400.0;
    const auto sinc = [](double x) { return std::sin(kPi * x) / (kPi * x); };
    for (int k = 0; k < kSteps; ++k) {
      const double x = kMost * (k + 0.5) / kSteps;
      sum += 2.0 * std::pow(sinc(x) * sinc(bar * x), 2.0) * kMost / kSteps;
    }
    Resolving c{[](double) { return 1.0; }, 1.0, 1.0, 1, 1.0, {}, {}};
    c.observer = {1.0, 1.0, 0.1, 0.4, 30.0, 0.0};
    c.noise.h = 1.0;
    const double f = 0.5 / bar;
    if (f > 0.5) continue;  // beyond half a cycle a pixel it is infinite
    figure(print("noise of columns left in bars of %g pixels", bar), std::pow(mrtd_K(c, Bars::SideBySide, f) * 8.0 / (kPi * kPi) * sinc(f), 2.0), sum, 1e-5,
           "integral of sinc^2 sinc^2; its end at 400 cycles");
  }
}

// Barten's formula at values worked out by hand from its terms; an eye is best at a few cycles a degree, worse where it is dark.
TEST(Mrtd, EyesThreshold) {
  // u = 4, 10 deg, 100 cd/m2: exp(-0.0016 x 16 x 2^0.08) = 0.97330, (1 + 1.44 + 10.24) (63 / 100^0.83 + 1 / (1 - exp(-0.32))) = 12.68 x (1.37828 + 3.65171).
  figure("eye's threshold at 4 cycles/deg", eyeThreshold(4.0, 10.0, 100.0), std::sqrt(12.68 * (1.37828 + 3.65171)) / (5200.0 * 0.97330), 1e-4,
         "Barten 2004; five digits by hand");
  for (const double luminance : {3.0, 30.0, 300.0}) {
    EXPECT_LT(eyeThreshold(4.0, 15.0, luminance), eyeThreshold(0.3, 15.0, luminance));
    EXPECT_LT(eyeThreshold(4.0, 15.0, luminance), eyeThreshold(25.0, 15.0, luminance));
    EXPECT_GT(eyeThreshold(10.0, 15.0, luminance), eyeThreshold(10.0, 15.0, 10.0 * luminance));
  }
  // With noise next to nothing what is left is the eye: twice the display's contrast, the first harmonic of bars.
  Resolving c = fine([](double) { return 1.0; }, 1e-12);
  c.pitchX_rad = c.pitchY_rad = 1e-4;
  c.noise.tvh = 1e-9;
  c.observer.sceneContrast_K = 4.0;
  const double height = 2.0 * std::atan(0.5 * 0.15 / 0.4), magnification = height / (512 * 1e-4), f = 4000.0, shown = std::sin(kPi * 0.4) / (kPi * 0.4);
  figure("MRTD of an eye alone [K]", mrtd_K(c, Bars::SideBySide, f),
         0.25 * kPi * 8.0 * eyeThreshold(f / magnification * kPi / 180.0, height * 180.0 / kPi, 30.0) / shown, 1e-9, "(pi / 4) 2 S m / H");
  // Bars coarser than the eye's best are seen from farther back: what is left between two of them is the display's squares.
  double least = INFINITY;
  for (double u = 0.2; u < 20.0; u *= 1.0001) least = std::min(least, eyeThreshold(u, height * 180.0 / kPi, 30.0));
  for (const double coarse : {50.0, 200.0, 500.0})
    figure(print("MRTD of an eye alone at %g cycles/mrad [K]", 1e-3 * coarse), mrtd_K(c, Bars::SideBySide, coarse),
           2.0 * kPi * least * kPi * 1e-4 * coarse / std::sin(kPi * 1e-4 * coarse), 1e-6, "the eye's best threshold; found to a ten-thousandth of its place");
}

// A Gaussian lens, no air: s f exp(2 pi^2 w^2 f^2) = dT gives f = sqrt(W(4 pi^2 w^2 (dT / s)^2) / 4 pi^2 w^2), and R = f h / N.
TEST(Acquisition, JohnsonRangeByHand) {
  for (const double width : {2e-5, 1e-4})
    for (const double difference : {0.5, 2.0, 10.0}) {
      const double density = 1e-5, s = slopeOf(density), q = 4.0 * kPi * kPi * width * width;
      const Resolving c = fine([width](double u) { return std::exp(-2.0 * kPi * kPi * width * width * u * u); }, density);
      const double f = std::sqrt(lambert(q * std::pow(difference / s, 2.0)) / q);
      // The search is for pixels' own half cycle; of a lens that is far coarser the first of 400 steps holds all, and halving goes on to 1e-15.
      for (const double cycles : neededFor(Criterion::Johnson)) {
        const AcquiredTarget target{2.3, 2.3, difference};
        figure(print("range of %g cycles, a lens of %g urad, %g K [m]", cycles, 1e6 * width, difference),
               rangeOf(c, target, Criterion::Johnson, cycles, [](double) { return 1.0; }), f * 2.3 / cycles, 1e-5, "Lambert's W; fine pixels, 1e-5");
      }
    }
}

// The same through air that dims as exp(-k R): R is where f(dT exp(-k R)) h / R = N, by fixed point.
TEST(Acquisition, JohnsonRangeThroughAir) {
  const double width = 5e-5, density = 1e-5, s = slopeOf(density), q = 4.0 * kPi * kPi * width * width;
  const Resolving c = fine([width](double u) { return std::exp(-2.0 * kPi * kPi * width * width * u * u); }, density);
  for (const double per_m : {0.2e-3, 1e-3}) {  // STANAG 4347's good and limited visibility
    double r = 1000.0;
    for (int k = 0; k < 400; ++k) r = 0.7 * r + 0.3 * std::sqrt(lambert(q * std::pow(2.0 * std::exp(-per_m * r) / s, 2.0)) / q) * 2.3 / 3.0;
    figure(print("recognition through %g /km [m]", 1e3 * per_m),
           rangeOf(c, {}, Criterion::Johnson, 3.0, [&](double range) { return std::exp(-per_m * range); }), r, 1e-5, "fixed point of Lambert's W");
  }
}

// TTP of a lens that lets all through: (pi / 4) dT / (s f) above 1 as far as F = pi dT / (4 s), the integral of sqrt(F / f) is 2 F; V = 2.3 m x 2 F / R.
TEST(Acquisition, TtpByHand) {
  constexpr double kPitch = 1e-4;
  for (const double difference : {0.02, 0.05, 0.1}) {
    Resolving c{
        [](double u) { return kPi * kPitch * u / std::sin(kPi * kPitch * u); }, kPitch, kPitch, 512, 50.0, {}, {}};  // takes back what the display's squares do
    c.observer.sceneContrast_K = 0.0;
    c.noise.vh = 0.02;
    // Of bars much larger than pixels s f, s = pi^2 / (4 sqrt 7) 2.25 sigma pitch; the pixels' own size takes (1 - p/3w)(1 - p/21w).
    const double s = kPi * kPi / (4.0 * std::sqrt(7.0)) * 2.25 * 0.02 * kPitch, cut = 0.25 * kPi * difference / s;
    double sum = 0.0;
    constexpr int kSteps = 200000;
    for (int k = 0; k < kSteps; ++k) {
      const double f = 5000.0 * (k + 0.5) / kSteps, w = 2.0 * kPitch * f, over = cut / (f * std::sqrt((1.0 - w / 3.0) * (1.0 - w / 21.0)));
      if (over > 1.0) sum += std::sqrt(over) * 5000.0 / kSteps;
    }
    const double v = seenOf(c, {2.3, 2.3, difference}, Criterion::Ttp, 1000.0, 1.0);
    figure(print("V of TTP at 1 km, %g K", difference), v, 2.3e-3 * sum, 3e-3, "the integral by itself; a step of 600 at its end");
    if (cut < 1000.0) {
      EXPECT_NEAR(v / (2.3e-3 * 2.0 * cut), 1.0, 0.05) << "2 F; pixels of a tenth of the bars";
    }
  }
}

TEST(Acquisition, ProbabilitiesOfTheCriteria) {
  for (const Criterion c : {Criterion::Johnson, Criterion::Ttp}) {
    EXPECT_DOUBLE_EQ(probabilityOf(c, 6.0, 6.0), 0.5);
    EXPECT_EQ(probabilityOf(c, 0.0, 6.0), 0.0);
    EXPECT_NEAR(probabilityOf(c, 1e4, 6.0), 1.0, 1e-12);
  }
  // Ratches 1976: twice the cycles, E = 4.1: 2^4.1 / (1 + 2^4.1); Vollmerhausen 2004: E = 1.99.
  EXPECT_NEAR(probabilityOf(Criterion::Johnson, 2.0, 1.0), 17.148 / 18.148, 1e-5);
  EXPECT_NEAR(probabilityOf(Criterion::Ttp, 26.0, 13.0), 3.9724 / 4.9724, 1e-5);
}

// The table that goes with Johnson's cycles, to its two digits: of what is needed for 50 %, 3 times give 1.00, 2 give 0.95, ... Source: Ratches 1976.
TEST(Acquisition, ProbabilitiesAsPublished) {
  for (const auto& [ratio, published] : {std::pair{3.0, 1.0}, std::pair{2.0, 0.95}, std::pair{1.5, 0.80}, std::pair{1.0, 0.50}, std::pair{0.75, 0.30},
                                         std::pair{0.5, 0.10}, std::pair{0.25, 0.02}, std::pair{0.0, 0.0}})
    bound(print("probability with %g of the cycles of 50 %%, off the table", ratio), std::abs(probabilityOf(Criterion::Johnson, 6.0 * ratio, 6.0) - published),
          0.025, "half of 0.05, to which the table is rounded");
}

// Farther for more contrast, a larger target, less noise, clearer air, fewer cycles.
TEST(Acquisition, IsMonotonous) {
  const auto camera = [](double netd) {
    Resolving c{[](double u) { return std::exp(-2.0 * kPi * kPi * 5e-5 * 5e-5 * u * u); }, 1.5e-4, 1.5e-4, 512, 50.0,
                {netd, 0.2 * netd, 0.2 * netd, 0.3 * netd, 0.1 * netd, 0.1 * netd},        {}};
    return c;
  };
  const auto air = [](double per_m) { return [per_m](double r) { return std::exp(-per_m * r); }; };
  for (const Criterion c : {Criterion::Johnson, Criterion::Ttp})
    for (std::size_t task = 0; task < 3; ++task) {
      const double needed = neededFor(c)[task], base = rangeOf(camera(0.03), {}, c, needed, air(2e-4));
      EXPECT_GT(base, 100.0);
      EXPECT_LT(base, 30000.0);
      EXPECT_GE(rangeOf(camera(0.03), {2.3, 2.3, 4.0}, c, needed, air(2e-4)), base);
      EXPECT_GT(rangeOf(camera(0.03), {4.0, 4.0, 2.0}, c, needed, air(2e-4)), base);
      EXPECT_GE(rangeOf(camera(0.02), {}, c, needed, air(2e-4)), base);
      EXPECT_LE(rangeOf(camera(0.3), {}, c, needed, air(2e-4)), base);
      EXPECT_LE(rangeOf(camera(0.03), {}, c, needed, air(1e-3)), base);
      if (task > 0) {
        EXPECT_LT(base, rangeOf(camera(0.03), {}, c, neededFor(c)[task - 1], air(2e-4)));
      }
    }
  EXPECT_EQ(rangeOf(camera(0.03), {2.3, 2.3, 1e-6}, Criterion::Johnson, 1.0, air(2e-4)), 0.0);
  double before = 0.0;
  for (double f = 200.0; f < 3300.0; f += 100.0) {
    const double now = mrtd_K(camera(0.03), Bars::SideBySide, f);
    EXPECT_GT(now, before) << f;
    before = now;
  }
  EXPECT_TRUE(std::isinf(mrtd_K(camera(0.03), Bars::SideBySide, 3400.0)));
}

// Tables of the normal distribution: Q(1.2816) = 0.1, Q(3.0902) = 1e-3, Q(4.7534) = 1e-6.
TEST(SpotDetection, ThresholdsOfTheNormalDistribution) {
  for (const auto& [q, k] :
       {std::pair{0.5, 0.0}, std::pair{0.1, 1.2815516}, std::pair{1e-3, 3.0902323}, std::pair{1e-6, 4.7534243}, std::pair{1e-9, 5.9978070}})
    EXPECT_NEAR(thresholdFor(q), k, 1e-6) << q;
  EXPECT_NEAR(detection(5.0, 5.0), 0.5, 1e-15);
  EXPECT_NEAR(detection(tnrFor(0.9, 4.2), 4.2), 0.9, 1e-12);
  // One false alarm an hour of 640 x 512 pixels at 50 Hz: 1.6954e-11 of them.
  EXPECT_NEAR(falseAlarms(thresholdForRate(1.0, 640.0 * 512.0 * 50.0)) * 3600.0 * 640.0 * 512.0 * 50.0, 1.0, 1e-9);
  EXPECT_THROW((void)thresholdFor(0.0), std::invalid_argument);
  EXPECT_THROW((void)thresholdFor(1.0), std::invalid_argument);
}

// Upward crossings of noise that an ideal filter leaves up to B: B / sqrt 3 exp(-k^2 / 2) a second (Rice), of 400 sines of random frequencies and phases.
TEST(SpotDetection, CrossingsByRice) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  constexpr int kSines = 400, kPoints = 120000;
  constexpr double kStep = 1.0 / 24.0;  // of 1 / B
  std::vector<double> noise(kPoints, 0.0);
  for (int s = 0; s < kSines; ++s) {
    const double frequency = (s + part(random)) / kSines, phase = 2.0 * kPi * part(random);
    for (int k = 0; k < kPoints; ++k) noise[static_cast<std::size_t>(k)] += std::sqrt(2.0 / kSines) * std::cos(2.0 * kPi * frequency * kStep * k + phase);
  }
  for (const double threshold : {0.5, 1.0, 2.0}) {
    int crossings = 0;
    for (std::size_t k = 1; k < noise.size(); ++k) crossings += noise[k - 1] <= threshold && noise[k] > threshold;
    const double expected = kPoints * kStep / std::sqrt(3.0) * std::exp(-0.5 * threshold * threshold);
    figure(print("crossings of %g sigma by chance", threshold), crossings, expected, 4.0 / std::sqrt(expected),
           "B / sqrt 3 exp(-k^2 / 2); 4 standard errors as if independent");
  }
  // B is half the pixels' rate: as many alarms an hour as asked for.
  for (const double alarms : {0.01, 1.0, 100.0}) {
    const double k = thresholdByCrossings(alarms, 640.0 * 512.0 * 50.0);
    EXPECT_NEAR(0.5 * 640.0 * 512.0 * 50.0 / std::sqrt(3.0) * std::exp(-0.5 * k * k) * 3600.0 / alarms, 1.0, 1e-9);
    EXPECT_GT(k, thresholdForRate(alarms, 640.0 * 512.0 * 50.0));
  }
  EXPECT_THROW((void)thresholdByCrossings(1e9, 1.0), std::invalid_argument);
}

// By chance: so many of a million normal numbers are above it, with a target and without.
TEST(SpotDetection, ByChance) {
  std::mt19937_64 random(20);
  std::normal_distribution<double> normal;
  for (const auto& [tnr, alarms] : {std::pair{3.0, 1e-2}, std::pair{4.0, 1e-3}, std::pair{2.0, 0.1}}) {
    const double threshold = thresholdFor(alarms);
    constexpr int kTrials = 1000000;
    int found = 0, alarm = 0;
    for (int k = 0; k < kTrials; ++k) found += tnr + normal(random) > threshold, alarm += normal(random) > threshold;
    const double p = detection(tnr, threshold);
    figure(print("detected by chance at a TNR of %g, alarms %g", tnr, alarms), static_cast<double>(found) / kTrials, p,
           4.0 * std::sqrt((1.0 - p) / (p * kTrials)), "Q(k - TNR); 4 standard errors");
    figure(print("false alarms by chance, %g", alarms), static_cast<double>(alarm) / kTrials, alarms, 4.0 * std::sqrt(1.0 / (alarms * kTrials)),
           "Q(k); 4 standard errors");
  }
}

}  // namespace
}  // namespace pitviper::test
