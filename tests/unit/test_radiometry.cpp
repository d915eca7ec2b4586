// Spectra, Planck's law, quadrature and spectral rules against published values and closed forms, in double precision.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/spectral_rule.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

TEST(Planck, PublishedValues) {
  // Wien's displacement law: the peak of B_lambda is at 2897.771955 um K (CODATA 2018).
  double best = 0.0, peak = 0.0;
  for (double w = 9.0; w < 10.5; w += 1e-4)
    if (const double b = physics::planckRadiance(w, 300.0); b > best) best = b, peak = w;
  figure("peak of Planck's law at 300 K [um]", peak, 2897.771955 / 300.0, 2e-5, "Wien displacement, CODATA 2018; search step");
  // Peak radiance: 4.0957e-6 W/(m2 sr um K^5) T^5 (Howell, Siegel: pi B_max = 1.2867e-11 W/(m2 um K^5) T^5 ... as exitance).
  figure("peak exitance / T^5 [W/(m2 um K5)]", kPi * best / std::pow(300.0, 5), 1.2867e-11, 1e-4,
         "Howell and Siegel, Thermal radiation heat transfer, table of constants");
  // Stefan-Boltzmann.
  const Spectrum body(Spectrum::BlackBody{400.0, 1.0});
  figure("exitance at 400 K [W/m2]", kPi * body.integral(0.5, 1000.0), kStefanBoltzmann * std::pow(400.0, 4), 2e-5,
         "sigma T^4; 2e-6 of it lies beyond 1000 um");
  // A sun of 5772 K and 6.7943e-5 sr: 1361 W/m2 (IAU 2015 nominal total solar irradiance).
  figure("black body sun [W/m2]", Spectrum(Spectrum::BlackBody{5772.0, 6.7943e-5}).integral(0.1, 1000.0), 1361.0, 1e-3, "IAU 2015 nominal solar irradiance");
}

TEST(Planck, SeriesOfTheTestsAgreesWithTheIntegral) {
  for (double t : {200.0, 300.0, 3000.0}) EXPECT_NEAR(Spectrum(Spectrum::BlackBody{t, 1.0}).integral(3, 5) / blackBodyBand(3, 5, t), 1.0, 1e-9) << t;
}

TEST(Planck, ExtremesAreZeroOrRight) {
  EXPECT_EQ(physics::planckRadiance(0.3, 2.0), 0.0);  // c2/(lambda T) = 24000
  EXPECT_EQ(physics::planckRadiance(10.0, 0.0), 0.0);
  // Rayleigh-Jeans: 2 c k T / lambda^4 for lambda T >> c2.
  EXPECT_NEAR(physics::planckRadiance(1000.0, 1e5) / (2.0 * kLightSpeed * kBoltzmann * 1e5 / 1e-12 * 1e-6), 1.0, 1e-4);
}

TEST(Exponentials, KeepTheirDigits) {
  for (double x : {1e-12, 1e-9, 1e-6, 1e-3, 0.12, 0.13, 1.0, 10.0, 700.0}) {
    EXPECT_NEAR(physics::oneMinusExp(x) / -std::expm1(-x), 1.0, 1e-12) << x;
    EXPECT_NEAR(physics::decay(x) / std::exp(-x), 1.0, 1e-13) << x;
  }
  for (double c : {1e-12, 1e-6, 0.01, 0.0499, 0.0501, 0.5, 0.999}) EXPECT_NEAR(physics::logOneMinus(c) / std::log1p(-c), 1.0, 1e-13) << c;
  EXPECT_EQ(physics::oneMinusExp(INFINITY), 1.0);
}

TEST(Quadrature, LegendreIsExactForPolynomials) {
  for (int n : {1, 2, 5, 16, 64}) {
    double sum = 0.0;
    const int degree = 2 * n - 1;
    for (const auto& p : gaussLegendre(n, 0.0, 1.0)) sum += p.weight * std::pow(p.x, degree);
    EXPECT_NEAR(sum, 1.0 / (degree + 1), 1e-13) << n;
  }
}

TEST(Quadrature, GaussRuleIsExactAgainstItsWeight) {
  // A triangle response on [3, 5] with peak at 4: integral of x^k against it by parts.
  const std::vector<double> knots{4.0};
  auto triangle = [](double x) { return 1.0 - std::abs(x - 4.0); };
  const auto rule = gaussRule(5, triangle, 3.0, 5.0, knots);
  ASSERT_EQ(rule.size(), 5u);
  for (int k = 0; k <= 9; ++k) {
    double sum = 0.0;
    for (const auto& p : rule) sum += p.weight * std::pow(p.x, k);
    const double exact = (std::pow(5.0, k + 2) - 2 * std::pow(4.0, k + 2) + std::pow(3.0, k + 2)) / ((k + 1.0) * (k + 2.0));
    EXPECT_NEAR(sum / exact, 1.0, 1e-12) << k;
  }
}

TEST(Quadrature, NarrowAndManyPointRulesHold) {
  const Spectrum narrow = Spectrum::band(10.0, 10.0001);
  double sum = 0.0;
  for (const auto& p : spectralRule(narrow, 16, Spacing::Gauss)) sum += p.weight;
  EXPECT_NEAR(sum, 1e-4, 1e-12);
  const auto many = spectralRule(Spectrum::band(0.4, 14.0), 340, Spacing::Gauss);
  ASSERT_EQ(many.size(), 340u);
  for (size_t i = 0; i + 1 < many.size(); ++i) EXPECT_LT(many[i].x, many[i + 1].x);
}

TEST(SpectralRule, BandEdgesAreExact) {
  for (Spacing spacing : {Spacing::Gauss, Spacing::Even, Spacing::Log}) {
    double sum = 0.0;
    for (const auto& p : spectralRule(Spectrum::band(3.123, 4.877), 7, spacing)) {
      sum += p.weight;
      EXPECT_GT(p.x, 3.123);
      EXPECT_LT(p.x, 4.877);
    }
    EXPECT_NEAR(sum, 4.877 - 3.123, 1e-12);
  }
}

// Channels that share their wavelengths: every band is still integrated from edge to edge.
TEST(SpectralRule, SharedNodesKeepEveryBand) {
  const Spectrum wide = Spectrum::band(3.6, 4.9), narrow = Spectrum::band(4.4, 4.6), far = Spectrum::band(8.0, 12.0);
  const auto pieces = commonPieces({&wide, &narrow, &far});
  ASSERT_EQ(pieces.size(), 4u) << "3.6-4.4, 4.4-4.6, 4.6-4.9, 8-12: nothing between the bands";
  for (Spacing spacing : {Spacing::Gauss, Spacing::Even, Spacing::Log})
    for (const auto* band : {&wide, &narrow, &far}) {
      double got = 0.0;
      for (const auto& p : sharedRule(*band, 32, spacing, pieces)) got += p.weight * physics::planckRadiance(p.x, 300.0);
      const double exact = blackBodyBand(band->supportLow(), band->supportHigh(), 300.0);
      EXPECT_NEAR(got / exact, 1.0, spacing == Spacing::Gauss ? 1e-4 : 1e-2) << band->supportLow();
    }
  const Spectrum spike(Spectrum::Table{{4.50, 4.501, 4.502}, {0, 1, 0}, Outside::Zero, ""});
  EXPECT_THROW(sharedRule(spike, 4, Spacing::Gauss, commonPieces({&wide})), std::invalid_argument);
}

// The default, 16 Gauss points: error over black bodies of 200 to 6000 K behind smooth emissivities and smooth air. This is the
// figure stated for `spectral`.
TEST(SpectralRule, DefaultErrorIsBelowAThousandth) {
  double worstGauss = 0.0, worstEven = 0.0;
  for (const auto& [low, high] : {std::pair{3.0, 5.0}, {8.0, 12.0}, {0.4, 0.7}, {1.0, 2.5}, {3.0, 12.0}}) {
    const Spectrum band = Spectrum::band(low, high);
    for (double t : {250.0, 300.0, 500.0, 1000.0, 2000.0, 6000.0}) {
      if (14387.77 / (low * t) > 60.0) continue;
      for (double depth : {0.0, 1.0, 4.0}) {
        auto radiance = [&](double w) { return (0.8 + 0.1 * std::sin(2.0 * w)) * physics::planckRadiance(w, t) * std::exp(-depth * std::pow(low / w, 1.3)); };
        const double exact = integrate(radiance, low, high, {});
        auto error = [&](Spacing s) {
          double sum = 0.0;
          for (const auto& p : spectralRule(band, 16, s)) sum += p.weight * radiance(p.x);
          return std::abs(sum / exact - 1.0);
        };
        worstGauss = std::max(worstGauss, error(Spacing::Gauss));
        worstEven = std::max(worstEven, error(Spacing::Even));
      }
    }
  }
  bound("spectral sampling, 16 Gauss points, smooth spectra, worst error", worstGauss, 1e-3, "quadrature error; five bands, 250-6000 K, optical depth 0-4");
  bound("spectral sampling, 16 even cells, smooth spectra, worst error", worstEven, 5e-2, "midpoint rule, for comparison");
}

TEST(Spectrum, TablesHoldZeroOrRefuse) {
  const Spectrum hold(Spectrum::Table{{1, 2}, {3, 5}, Outside::Hold, ""}), zero(Spectrum::Table{{1, 2}, {3, 5}, Outside::Zero, ""});
  const Spectrum error(Spectrum::Table{{1, 2}, {3, 5}, Outside::Error, "x"});
  EXPECT_EQ(hold(0.5), 3.0);
  EXPECT_EQ(hold(9.0), 5.0);
  EXPECT_EQ(zero(2.5), 0.0);
  EXPECT_EQ(error(1.5), 4.0);
  EXPECT_THROW(error(2.5), OutsideSpectrum);
  EXPECT_EQ((zero * error)(0.5), 0.0) << "a response's zero hides what other factors don't know";
  EXPECT_EQ((error * zero)(0.5), 0.0);
  EXPECT_THROW(Spectrum(Spectrum::Table{{2, 1}, {0, 0}, Outside::Hold, ""}), std::invalid_argument);
  EXPECT_THROW(Spectrum(Spectrum::Table{{1, 2}, {0, NAN}, Outside::Hold, ""}), std::invalid_argument);
  EXPECT_NEAR(zero.integral(0.5, 3.0), 4.0, 1e-12);
}

TEST(Geometry, FluxOfTheSevenStepsIsTheCancelledForm) {
  // Steps 1 to 5 with cos(theta_v) restored, against L w_pix A_ap cos(psi).
  const double pixel = 1e-6, range = 2000.0, cosView = 0.3, cosPsi = 0.98, cosLight = 0.7, distance = 40.0, aperture = 1e-3, intensity = 120.0, brdf = 0.1;
  const double area = physics::fragmentArea(pixel, range, cosView);
  const double onto = 4.0 * kPi * intensity * physics::fragmentFromLight(area, cosLight, distance * distance) / (4.0 * kPi);
  const double radiance = brdf * onto / area;
  const double flux = radiance * area * cosView * physics::apertureFromFragment(aperture, cosPsi, range);
  EXPECT_NEAR(flux / (brdf * intensity * physics::pointIrradianceFactor(cosLight, distance * distance, 0.05) * pixel * aperture * cosPsi), 1.0, 1e-12);
}

}  // namespace
}  // namespace pitviper::test
