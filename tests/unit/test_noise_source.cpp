// Random numbers by counter: published vectors, and moments and shares of what is made of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sensors/noise_source.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"

namespace pitviper::test {
namespace {

// Source: kat_vectors of Random123 (philox4x32, 10 rounds).
TEST(NoiseSource, PhiloxIsAsPublished) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

constexpr int kDraws = 400000;

/// Mean, variance and third central moment.
std::array<double, 3> momentsOf(const std::vector<double>& x) {
  const auto n = static_cast<double>(x.size());
  double mean = 0.0, second = 0.0, third = 0.0;
  for (double v : x) mean += v / n;
  for (double v : x) second += (v - mean) * (v - mean) / n, third += (v - mean) * (v - mean) * (v - mean) / n;
  return {mean, second, third};
}

TEST(NoiseSource, NormalNumbersAre) {
  const NoiseSource source(7, 0, 3, NoiseEffect::Read);
  std::vector<double> all;
  int beyond = 0;
  for (std::uint32_t k = 0; k < kDraws; ++k) all.push_back(source.normal(k)), beyond += std::abs(all.back()) > 3.0;
  const auto [mean, variance, third] = momentsOf(all);
  const double n = kDraws;
  bound("mean of 400,000 normal numbers", std::abs(mean), 4.0 / std::sqrt(n), "4 standard errors");
  bound("their variance off 1", std::abs(variance - 1.0), 4.0 * std::sqrt(2.0 / n), "4 standard errors");
  bound("their third moment", std::abs(third), 4.0 * std::sqrt(15.0 / n), "4 standard errors");
  bound("share beyond 3 off 0.0027", std::abs(beyond / n - 0.0026998), 4.0 * std::sqrt(0.0027 / n), "4 standard errors");
}

// Abramowitz and Stegun, table 26; Wichura's own check values.
TEST(NoiseSource, NormalQuantiles) {
  EXPECT_EQ(normalQuantile(0.5), 0.0);
  EXPECT_NEAR(normalQuantile(0.975), 1.959963984540054, 1e-14);
  EXPECT_NEAR(normalQuantile(0.25), -0.6744897501960817, 1e-15);
  EXPECT_NEAR(normalQuantile(0.001), -3.090232306167814, 1e-14);
  EXPECT_NEAR(normalQuantile(1e-20), -9.262340089798408, 1e-13);
  for (double u : {1e-12, 1e-4, 0.07, 0.0751, 0.3, 0.9, 0.99999}) EXPECT_NEAR(0.5 * std::erfc(-normalQuantile(u) / std::sqrt(2.0)) / u, 1.0, 1e-12) << u;
}

// Every way a count is drawn: all three moments of Poisson's law are its mean.
TEST(NoiseSource, CountsArePoissons) {
  const double n = kDraws;
  for (double mean : {0.3, 4.0, 9.9, 10.1, 35.0, 1000.0, 9999.0, 10001.0, 3e5, 2e7}) {
    const NoiseSource source(7, 0, 3, NoiseEffect::Shot);
    std::vector<double> all;
    for (std::uint32_t k = 0; k < kDraws; ++k) all.push_back(source.poisson(mean, k));
    const auto [found, variance, third] = momentsOf(all);
    bound(print("counts of mean %g: mean off, in standard errors", mean), std::abs(found - mean) / std::sqrt(mean / n), 4.0, "4");
    bound(print("counts of mean %g: variance off, in standard errors", mean), std::abs(variance - mean) / std::sqrt((mean + 2.0 * mean * mean) / n), 4.0, "4");
    if (mean < 1e7)
      bound(print("counts of mean %g: third moment off, in standard errors", mean),
            std::abs(third - mean) / std::sqrt((15.0 * mean * mean * mean + 36.0 * mean * mean + 40.0 * mean) / n), 5.0, "about 4");
    if (mean > 20.0) continue;
    double share = std::exp(-mean), chi2 = 0.0;
    int classes = 0;
    for (int count = 0; count < 60; ++count, share *= mean / count) {
      if (share * n < 50.0) continue;
      const double seen = static_cast<double>(std::count(all.begin(), all.end(), count));
      chi2 += (seen - share * n) * (seen - share * n) / (share * n);
      ++classes;
    }
    bound(print("counts of mean %g: chi2 of %g classes", mean, 1.0 * classes), chi2, classes + 4.0 * std::sqrt(2.0 * classes), "4 standard deviations");
  }
}

TEST(NoiseSource, DependsOnAllItIsFor) {
  const double base = NoiseSource(1, 0, 1, NoiseEffect::Shot).uniform(5);
  EXPECT_EQ(base, NoiseSource(1, 0, 1, NoiseEffect::Shot).uniform(5));
  for (double other : {NoiseSource(2, 0, 1, NoiseEffect::Shot).uniform(5), NoiseSource(1, 1, 1, NoiseEffect::Shot).uniform(5),
                       NoiseSource(1, 0, 2, NoiseEffect::Shot).uniform(5), NoiseSource(1, 0, 1, NoiseEffect::Read).uniform(5),
                       NoiseSource(1, 0, 1, NoiseEffect::Shot).uniform(6)})
    EXPECT_NE(base, other);
}

}  // namespace
}  // namespace pitviper::test
