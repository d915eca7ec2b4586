// What fits spend their time on, against the standard's exponential and plain sums, for any number of groups.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/plan/group_kernels.hpp"
#include "sim/radiometry/exponentials.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/numbers.hpp"

namespace pitviper::test {
namespace {

TEST(GroupKernels, ExponentialsAreTheStandards) {
  std::vector<double> x;
  for (double v = 0.0; v > -700.0; v = 1.01 * v - 1e-5) x.push_back(v), x.push_back(-v);
  std::vector<double> y = x;
  exponentials(y.data(), static_cast<int>(y.size()));
  double worst = 0.0;
  for (size_t i = 0; i < x.size(); ++i) worst = std::max(worst, std::abs(y[i] / std::exp(x[i]) - 1.0));
  bound("exponentials from -700 to 700 against the standard's, relative", worst, 1e-13, "series of eleven: 6e-15; rounding of n ln 2, 700 x 2^-53");
  EXPECT_EQ(y.front(), 1.0);
  double far[] = {-701.0, -1e9, -INFINITY};
  exponentials(far, 3);
  for (double v : far) EXPECT_LE(v, std::exp(-699.0)) << "darker than anything that is seen";
  double none[] = {1.0, NAN};
  exponentials(none, 2);
  EXPECT_TRUE(std::isnan(none[1])) << none[1];
}

TEST(GroupKernels, SumsAreThoseOfAnyNumberOfGroups) {
  constexpr int kColumns = 3, kPaths = 300, kFine = 7, kSpectra = 5;
  for (int groups = 1; groups <= 9; ++groups) {
    Numbers random(static_cast<unsigned>(groups));
    const int padded = paddedGroups(groups);
    ASSERT_GE(padded, groups);
    std::vector<double> extinction(static_cast<size_t>(padded * kColumns)), share(static_cast<size_t>(padded * kFine)), spectra(kSpectra * kFine),
        amounts(kColumns * kPaths);
    for (double& v : extinction) v = random(0.0, 3.0);
    for (double& v : share) v = random(0.0, 1.0);
    for (double& v : spectra) v = random(0.0, 1.0);
    for (size_t i = 0; i < amounts.size(); ++i) amounts[i] = i % 3 == 1 ? 0.0 : random(0.0, 4.0);
    SparseAmounts sparse;
    for (int p = 0; p < kPaths; ++p) sparse.add(amounts.data() + kColumns * p, kColumns);
    std::vector<double> through(static_cast<size_t>(padded * kPaths)), sums(static_cast<size_t>(padded * kSpectra));
    transmittances(sparse, 0, static_cast<int>(sparse.first.size()) - 1, extinction.data(), padded, through.data());
    averages(share.data(), spectra.data(), kFine, kSpectra, padded, sums.data());
    double worst = 0.0;
    for (int g = 0; g < groups; ++g) {
      for (int p = 0; p < kPaths; ++p) {
        double depth = 0.0;
        for (int k = 0; k < kColumns; ++k) depth += extinction[static_cast<size_t>(padded * k + g)] * amounts[static_cast<size_t>(kColumns * p + k)];
        worst = std::max(worst, std::abs(through[static_cast<size_t>(padded * p + g)] * std::exp(depth) - 1.0));
      }
      for (int s = 0; s < kSpectra; ++s) {
        double sum = 0.0;
        for (int i = 0; i < kFine; ++i) sum += share[static_cast<size_t>(padded * i + g)] * spectra[static_cast<size_t>(kFine * s + i)];
        worst = std::max(worst, std::abs(sums[static_cast<size_t>(padded * s + g)] / sum - 1.0));
      }
    }
    bound("transmittances and averages of " + std::to_string(groups) + " groups against plain sums, relative", worst, 1e-13, "rounding");
  }
}

}  // namespace
}  // namespace pitviper::test
