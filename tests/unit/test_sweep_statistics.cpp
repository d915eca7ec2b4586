// What sweeps come to, against figures worked by hand and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "scenarios/sweep/sample_moments.hpp"
#include "scenarios/sweep/sweep_statistics.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper::test {
namespace {

/// Of the last digits of sums of some ten numbers near 1.
constexpr double kSumRounding = 1e-12;

SweepIdentity twoFactors(int samples) {
  SweepIdentity s{"s", "1", "s.yaml", "1", samples, {{"x", "km"}, {"sky", "", {"clear", "overcast"}}}, {}};
  Measure both;
  both.names = {"a", "b"}, both.units = {"K", ""};
  s.measures = {both};
  return s;
}

TEST(SweepStatistics, QuantilesOfKnownNumbers) {
  // Places (n - 1) p from 0: 0.15, 0.75, 1.5, 2.25, 2.85 of four numbers.
  const std::vector<double> rising{10.0, 20.0, 30.0, 50.0};
  const std::vector<double> wanted{10.0, 11.5, 17.5, 25.0, 35.0, 47.0, 50.0};
  for (std::size_t q = 0; q < wanted.size(); ++q) EXPECT_NEAR(quantileOf(rising, kSweepQuantiles[q]), wanted[q], 50.0 * kSumRounding);
  EXPECT_EQ(quantileOf({3.0}, 0.3), 3.0);
  EXPECT_TRUE(std::isnan(quantileOf({}, 0.5)));
  EXPECT_EQ(quantileOf({1.0, INFINITY, INFINITY}, 0.75), INFINITY);
}

TEST(SweepStatistics, RankCorrelationsWorkedByHand) {
  // Ranks 1, 2.5, 2.5, 4 and 1, 4, 2.5, 2.5: deviations -1.5, 0, 0, 1.5 and -1.5, 1.5, 0, 0, so 2.25 / sqrt(4.5 * 4.5).
  EXPECT_EQ(ranksOf({1.0, 7.0, 7.0, 9.0}), (std::vector<double>{1.0, 2.5, 2.5, 4.0}));
  EXPECT_NEAR(rankCorrelation({1.0, 7.0, 7.0, 9.0}, {-5.0, 3.0, 2.0, 2.0}), 0.5, kSumRounding);
  // Three equal: ranks 2, 2, 2, 4 and 1, 2, 3, 4: deviations -0.5 (thrice), 1.5 and -1.5, -0.5, 0.5, 1.5, so 3 / sqrt(3 * 5).
  EXPECT_NEAR(rankCorrelation({0.0, 0.0, 0.0, 1.0}, {1.0, 2.0, 3.0, 4.0}), 3.0 / std::sqrt(15.0), kSumRounding);
  // Without ties: 1 - 6 * 194 / (10 * 99).
  EXPECT_NEAR(rankCorrelation({106, 100, 86, 101, 99, 103, 97, 113, 112, 110}, {7, 27, 2, 50, 28, 29, 20, 12, 6, 17}), -29.0 / 165.0, kSumRounding);
  EXPECT_EQ(rankCorrelation({1.0, 2.0, INFINITY}, {1e-300, 2e-300, 1e300}), 1.0);
  EXPECT_TRUE(std::isnan(rankCorrelation({1.0, 1.0, 1.0}, {1.0, 2.0, 3.0})));
  EXPECT_TRUE(std::isnan(rankCorrelation({}, {})));
}

TEST(SweepStatistics, IntervalsOfCorrelations) {
  // atanh(0.5) = 0.549306, its error sqrt(1.125 / 25) = 0.212132: tanh(0.133535) and tanh(0.965077), to the six digits written.
  const Interval i = correlationInterval(0.5, 28);
  EXPECT_NEAR(i.low, 0.132747, 1e-6);
  EXPECT_NEAR(i.high, 0.746533, 1e-6);
  EXPECT_EQ(correlationInterval(1.0, 9).low, 1.0);
  EXPECT_TRUE(std::isnan(correlationInterval(0.5, 3).low));
  // Of lists that have nothing to do with each other 95 % hold 0; four standard errors of 2000 draws are 2 %.
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform;
  int hold = 0;
  for (int k = 0; k < 2000; ++k) {
    std::vector<double> x(30), y(30);
    for (double& v : x) v = uniform(random);
    for (double& v : y) v = uniform(random);
    const Interval found = correlationInterval(rankCorrelation(x, y), 30);
    hold += found.low <= 0.0 && found.high >= 0.0;
  }
  EXPECT_NEAR(hold / 2000.0, 0.95, 0.02);
}

TEST(SweepStatistics, FailedAndMissingSamplesAreCounted) {
  const std::vector<SweepRow> rows{{0, 0, {1.0, 0.0}, {2.0, 5.0}, ""},
                                   {1, 0, {2.0, 1.0}, {4.0, NAN}, ""},
                                   {3, 0, {3.0, 1.0}, {}, "no sun"},
                                   {4, 0, {4.0, 1.0}, {9.0, 5.0}, ""},
                                   {5, 0, {5.0, 0.0}, {1.0, 5.0}, ""}};
  const auto found = sweepStatistics(twoFactors(10), rows, false);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].name, "a");
  EXPECT_EQ(found[0].unit, "K");
  EXPECT_EQ(found[0].count, 4);
  EXPECT_EQ(found[0].failed, 1);
  EXPECT_EQ(found[0].missing, 0);
  EXPECT_EQ(found[1].count, 3);
  EXPECT_EQ(found[1].missing, 1);
  // 2, 4, 9, 1: squares about 4 are 4 + 0 + 25 + 9.
  EXPECT_NEAR(found[0].mean, 4.0, kSumRounding);
  EXPECT_NEAR(found[0].sigma, std::sqrt(38.0 / 3.0), 10.0 * kSumRounding);
  EXPECT_NEAR(found[0].quantiles[3], 3.0, kSumRounding);
  // Ranks 1, 2, 3, 4 and 2, 3, 4, 1: 1 - 6 * 12 / 60; with the choice's 1.5, 3.5, 3.5, 1.5: 4 / sqrt(4 * 5).
  EXPECT_NEAR(found[0].withFactor[0].rho, -0.2, kSumRounding);
  EXPECT_NEAR(found[0].withFactor[1].rho, 4.0 / std::sqrt(20.0), kSumRounding);
  EXPECT_EQ(found[0].withFactor[0].samples, 4);
  EXPECT_FALSE(found[0].sobol);
  EXPECT_EQ(found[1].sigma, 0.0);
  EXPECT_TRUE(std::isnan(found[1].withFactor[0].rho));
  const auto none = sweepStatistics(twoFactors(10), {}, true);
  EXPECT_EQ(none[0].count, 0);
  EXPECT_TRUE(std::isnan(none[0].mean));
  EXPECT_EQ(none[0].sobol->rows, 0);
  EXPECT_TRUE(std::isnan(none[0].sobol->factors[1].total));
}

/// By sample, of a function of `d` numbers even in 0..1.
std::vector<double> saltelliResults(const std::function<double(const std::vector<double>&)>& f, std::size_t d, int rows, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> results;
  for (int r = 0; r < rows; ++r) {
    std::vector<double> a(d), b(d);
    for (double& v : a) v = uniform(random);
    for (double& v : b) v = uniform(random);
    results.push_back(f(a)), results.push_back(f(b));
    for (std::size_t i = 0; i < d; ++i) {
      std::vector<double> mixed = a;
      mixed[i] = b[i];
      results.push_back(f(mixed));
    }
  }
  return results;
}

double ishigami(const std::vector<double>& u) {
  const auto angle = [&](std::size_t i) { return kPi * (2.0 * u[i] - 1.0); };
  return std::sin(angle(0)) + 7.0 * std::pow(std::sin(angle(1)), 2) + 0.1 * std::pow(angle(2), 4) * std::sin(angle(0));
}

TEST(SweepStatistics, IndicesOfIshigamisFunction) {
  // Its closed form for a = 7, b = 0.1.
  const double b4 = 0.1 * std::pow(kPi, 4), v1 = 0.5 * std::pow(1.0 + b4 / 5.0, 2), v2 = 49.0 / 8.0, v13 = 8.0 * b4 * b4 / 225.0, v = v1 + v2 + v13;
  const double first[3] = {v1 / v, v2 / v, 0.0}, total[3] = {(v1 + v13) / v, v2 / v, v13 / v};
  EXPECT_NEAR(first[0], 0.3139, 5e-5);
  EXPECT_NEAR(total[0], 0.5576, 5e-5);
  constexpr int kTimes = 40, kRows = 500;
  double sum[2][3] = {}, squares[2][3] = {}, width[2][3] = {};
  int hold = 0;
  for (unsigned k = 0; k < kTimes; ++k) {
    const SobolIndices found = sobolIndices(saltelliResults(ishigami, 3, kRows, k), 3);
    EXPECT_EQ(found.rows, kRows);
    for (std::size_t i = 0; i < 3; ++i) {
      const SobolIndex& s = found.factors[i];
      const auto add = [&](int which, double value, Interval interval, double wanted) {
        sum[which][i] += value, squares[which][i] += value * value, width[which][i] += interval.high - interval.low;
        hold += interval.low <= wanted && wanted <= interval.high;
      };
      add(0, s.first, s.firstInterval, first[i]), add(1, s.total, s.totalInterval, total[i]);
    }
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (int which : {0, 1}) {
      const double mean = sum[which][i] / kTimes, sigma = std::sqrt((squares[which][i] / kTimes - mean * mean) * kTimes / (kTimes - 1));
      // Four standard errors of the mean of 40 designs, as those scatter: each 0.065 at most, so 0.041.
      EXPECT_NEAR(mean, which == 0 ? first[i] : total[i], 4.0 * sigma / std::sqrt(kTimes)) << i << " " << which;
      EXPECT_LT(sigma, 0.08);
      // Intervals are as wide as 40 designs scatter; these know it within 4 / sqrt(80) = 45 %.
      EXPECT_NEAR(width[which][i] / kTimes / (2.0 * 1.96 * sigma), 1.0, 0.45) << i << " " << which;
    }
  // Of 240 intervals 95 % hold the index. Six of a design are not independent of each other: four standard errors of 40 are 14 %.
  EXPECT_NEAR(hold / 240.0, 0.95, 0.14);
}

TEST(SweepStatistics, RowsWithAFailedSampleAreLeftOut) {
  std::vector<double> results = saltelliResults(ishigami, 3, 200, 9), without = results;
  without.erase(without.begin() + 5 * 17, without.begin() + 5 * 18);
  results[5 * 17 + 3] = NAN;
  const SobolIndices found = sobolIndices(results, 3), wanted = sobolIndices(without, 3);
  EXPECT_EQ(found.rows, 199);
  EXPECT_EQ(found.leftOut, 1);
  // A billion added takes 1e9 * 2e-16 of each result's 4 or so.
  std::vector<double> far = without;
  for (double& r : far) r += 1e9;
  const SobolIndices offset = sobolIndices(far, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found.factors[i].first, wanted.factors[i].first);
    EXPECT_EQ(found.factors[i].totalInterval.high, wanted.factors[i].totalInterval.high);
    EXPECT_NEAR(offset.factors[i].first, wanted.factors[i].first, 1e-6);
    EXPECT_NEAR(offset.factors[i].total, wanted.factors[i].total, 1e-6);
  }
  const SobolIndices constant = sobolIndices(std::vector<double>(50, 0.1), 3);
  EXPECT_TRUE(std::isnan(constant.factors[0].first));
  EXPECT_THROW(sobolIndices(std::vector<double>(7, 0.1), 3), std::invalid_argument);
}

// Correlations of a Saltelli design are those of A and B, which know nothing of each other.
TEST(SweepStatistics, OfASaltelliDesign) {
  const auto f = [](const std::vector<double>& x) { return x[0] + 3.0 * (x[1] > 0.5 ? 1.0 : 0.0); };
  constexpr int kRows = 100;
  const std::vector<double> results = saltelliResults(f, 2, kRows, 4);
  std::vector<SweepRow> rows;
  for (int i = 0; i < 4 * kRows; ++i) {
    const double result = results[static_cast<std::size_t>(i)];
    rows.push_back({i, 0, {result - 3.0 * std::floor(result / 3.0), std::floor(result / 3.0)}, {result, -result}, ""});
  }
  rows[6].measures.clear(), rows[6].why = "failed";
  std::reverse(rows.begin(), rows.end());
  const auto found = sweepStatistics(twoFactors(4 * kRows + 4), rows, true);
  EXPECT_EQ(found[0].count, 4 * kRows - 1);
  EXPECT_EQ(found[0].withFactor[0].samples, 2 * kRows);
  ASSERT_TRUE(found[0].sobol);
  EXPECT_EQ(found[0].sobol->rows, kRows - 1);
  EXPECT_EQ(found[0].sobol->leftOut, 2) << "one with a failed sample, one not drawn yet";
  // Variances 1/12 and 9/4: additive, so that both indices are 0.036 and 0.964; half the interval is two standard errors, three halves of it three.
  for (const MeasureStatistics& m : found)
    for (std::size_t i = 0; i < 2; ++i) {
      const SobolIndex& s = m.sobol->factors[i];
      const double wanted = i == 0 ? 1.0 / 28.0 : 27.0 / 28.0;
      EXPECT_NEAR(s.first, wanted, 0.75 * (s.firstInterval.high - s.firstInterval.low));
      EXPECT_NEAR(s.total, wanted, 0.75 * (s.totalInterval.high - s.totalInterval.low));
      EXPECT_LT(s.totalInterval.high - s.totalInterval.low, 0.5);
    }
}

}  // namespace
}  // namespace pitviper::test
