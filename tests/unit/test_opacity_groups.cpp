// Opacity groups against closed forms, and problems at the edges.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "sim/plan/opacity_groups.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

constexpr int kFine = 60;

/// A flat response over 3-5 um, sources that bend over it, and each of them on each path.
SpectralProblem problem(std::vector<std::vector<double>> extinction, const std::vector<std::vector<double>>& paths) {
  SpectralProblem p;
  for (int i = 0; i < kFine; ++i) {
    p.wavelength_um.push_back(3.0 + 2.0 * (i + 0.5) / kFine);
    p.weight.push_back(2.0 / kFine);
  }
  for (int s = 0; s < 5; ++s) {
    p.spectra.emplace_back();
    for (double um : p.wavelength_um) p.spectra.back().push_back(1.0 + 0.8 * std::sin(2.0 * um + s) + 0.1 * s);
  }
  p.extinction = std::move(extinction);
  p.paths = paths;
  for (int s = 0; s < 5; ++s)
    for (int u = 0; u < static_cast<int>(paths.size()); ++u) p.products.push_back({{{{s}, 1, u, 1.0}}, 1e-4});
  return p;
}

std::vector<double> per(double (*f)(int)) {
  std::vector<double> v;
  for (int i = 0; i < kFine; ++i) v.push_back(f(i));
  return v;
}

const std::vector<std::vector<double>> kRanges = {{0.0}, {0.1}, {0.5}, {1.0}, {3.0}, {8.0}, {30.0}};

/// What must hold of any result: shares and weights add up, nothing negative, nothing but numbers.
void expectSound(const SpectralProblem& p, const GroupFit& fit) {
  ASSERT_FALSE(fit.groups.empty());
  EXPECT_LE(fit.groups.size(), p.weight.size());
  EXPECT_TRUE(std::isfinite(fit.maximum));
  EXPECT_TRUE(std::isfinite(fit.p99));
  std::vector<double> shared(p.weight.size(), 0.0);
  for (const SpectralGroup& g : fit.groups) {
    double shares = 0.0;
    for (const auto& [i, share] : g.members) {
      EXPECT_GT(share, 0.0);
      shares += share;
      shared[static_cast<size_t>(i)] += share * g.weight;
    }
    EXPECT_NEAR(shares, 1.0, 1e-12);
    EXPECT_GE(g.weight, 0.0);
    ASSERT_EQ(g.extinction.size(), p.extinction.size());
    for (double c : g.extinction) EXPECT_TRUE(std::isfinite(c) && c >= 0.0);
  }
  for (size_t i = 0; i < shared.size(); ++i) EXPECT_NEAR(shared[i], p.weight[i], 1e-12 * (1.0 + p.weight[i]));
}

// Shares are divided and added up again: some tens of roundings.
constexpr double kRounding = 1e-12;

TEST(OpacityGroups, GreyAirIsOneGroup) {
  const SpectralProblem p = problem({per([](int) { return 0.37; })}, kRanges);
  const GroupFit fit = fitToTolerance(p, 1e-9, 20);
  expectSound(p, fit);
  EXPECT_EQ(fit.groups.size(), 1u);
  figure("grey air: extinction of the one group", fit.groups[0].extinction[0], 0.37, kRounding, "the same at every wavelength");
  bound("grey air: error of one group", fit.maximum, kRounding, "exact; rounding");
}

TEST(OpacityGroups, TwoValuesAreTwoGroups) {
  const SpectralProblem p = problem({per([](int i) { return i % 3 == 0 ? 2.0 : 0.05; })}, kRanges);
  const GroupFit fit = fitToTolerance(p, 1e-3, 20);
  expectSound(p, fit);
  ASSERT_EQ(fit.groups.size(), 2u);
  const GroupFit exact = fitGroups(p, 2);
  const auto [low, high] = std::minmax(exact.groups[0].extinction[0], exact.groups[1].extinction[0]);
  figure("air of two values: the clear group", low, 0.05, kRounding, "closed form; rounding");
  figure("air of two values: the dim group", high, 2.0, kRounding, "closed form; rounding");
  bound("air of two values: error of two groups", exact.maximum, kRounding, "closed form; rounding");
}

TEST(OpacityGroups, WithoutAbsorbersOneGroupIsExact) {
  SpectralProblem none = problem({}, {{}, {}});
  const GroupFit fit = fitToTolerance(none, 1e-9, 8);
  expectSound(none, fit);
  EXPECT_EQ(fit.groups.size(), 1u);
  bound("no columns: error of one group", fit.maximum, kRounding, "linear averages; rounding");
  const SpectralProblem clear = problem({per([](int i) { return 0.1 * i; })}, {{0.0}});
  EXPECT_EQ(fitToTolerance(clear, 1e-9, 8).groups.size(), 1u);
}

// <e B> is not <e> <B> where both vary: a group per value of a two-valued emissivity makes it so.
TEST(OpacityGroups, SeparateFactorsForceGroups) {
  SpectralProblem p = problem({}, {{}});
  p.spectra.push_back(per([](int i) { return i < kFine / 3 ? 0.9 : 0.2; }));
  p.products.clear();
  for (int s = 0; s < 5; ++s) p.products.push_back({{{{s, 5}, 2, 0, 1.0}}, 1e-4});
  const GroupFit one = fitGroups(p, 1), two = fitGroups(p, 2);
  expectSound(p, two);
  EXPECT_GT(one.maximum, 0.02);
  bound("two-valued emissivity as a factor of its own: error of two groups", two.maximum, kRounding, "closed form: two groups are exact; rounding");
  EXPECT_EQ(fitToTolerance(p, 1e-3, 10).groups.size(), 2u);
}

TEST(OpacityGroups, PathRadianceAndTwoColumns) {
  SpectralProblem p = problem({per([](int i) { return std::exp(-0.15 * std::abs(i - 20)) * 5.0; }), per([](int i) { return 0.02 + 0.01 * (i % 7); })}, {});
  for (double r : {0.0, 0.2, 1.0, 4.0, 15.0}) p.paths.push_back({std::pow(r, 0.6), r});
  p.products.clear();
  for (int s = 0; s < 5; ++s)
    for (int u = 1; u < 5; ++u) {
      p.products.push_back({{{{s}, 1, u, 1.0}}, 1e-4});
      p.products.push_back({{{{s}, 1, 0, 1.0}, {{s}, 1, u, -1.0}}, 1e-4});
    }
  double before = INFINITY;
  for (int n : {1, 3, 6}) {
    const GroupFit fit = fitGroups(p, n);
    expectSound(p, fit);
    EXPECT_LT(fit.maximum, before);
    before = fit.maximum;
  }
  EXPECT_LT(before, 2e-3);
  const GroupFit a = fitGroups(p, 3), b = fitGroups(p, 3);
  EXPECT_EQ(a.maximum, b.maximum);
  for (size_t g = 0; g < a.groups.size(); ++g) EXPECT_EQ(a.groups[g].extinction, b.groups[g].extinction);
  EXPECT_NEAR(evaluateGroups(p, a.groups).maximum, a.maximum, 1e-12);
}

TEST(OpacityGroups, EdgesOfWhatCanBeAsked) {
  const auto column = per([](int i) { return 1e-3 * std::exp(0.2 * i); });
  SpectralProblem p = problem({column}, kRanges);
  // As many groups as wavelengths are exact, and there are never more.
  SpectralProblem small = p;
  for (auto* v : {&small.weight, &small.wavelength_um, &small.extinction[0]}) v->resize(3);
  for (auto& s : small.spectra) s.resize(3);
  const GroupFit all = fitGroups(small, 50);
  expectSound(small, all);
  EXPECT_LE(all.groups.size(), 3u);
  bound("a group per wavelength", all.maximum, kRounding, "point nodes are exact; rounding");
  // Zero weights, a source that is zero in part, one that is zero everywhere, opaque paths, a product without terms or without a floor.
  for (size_t i = 0; i < 20; ++i) p.weight[i] = 0.0;
  for (size_t i = 0; i < 40; ++i) p.spectra[0][i] = 0.0;
  std::fill(p.spectra[1].begin(), p.spectra[1].end(), 0.0);
  p.paths.push_back({1e30});
  p.products.push_back({{{{2}, 1, 7, 1.0}}, 0.0});
  p.products.push_back({{}, 0.0});
  p.products.push_back({{{{2}, 1, 0, 1.0}, {{2}, 1, 0, -1.0}}, 0.0});
  for (int n : {-1, 0, 1, 4, 1000}) expectSound(p, fitGroups(p, n, {6, 100, 0.0}));
  expectSound(p, fitToTolerance(p, 1e-2, 12));
  // A channel that sees nothing; no products; one product.
  SpectralProblem blind = p;
  std::fill(blind.weight.begin(), blind.weight.end(), 0.0);
  expectSound(blind, fitToTolerance(blind, 1e-2, 5));
  SpectralProblem idle = p;
  idle.products.clear();
  expectSound(idle, fitToTolerance(idle, 1e-2, 5));
  idle.products.push_back(p.products[3]);
  expectSound(idle, fitToTolerance(idle, 1e-2, 5));
  // A budget of time that is spent at once.
  expectSound(p, fitToTolerance(p, 1e-6, 12, {40, 600, 1e-9}));
}

TEST(OpacityGroups, ManyProducts) {
  SpectralProblem p = problem({per([](int i) { return 1e-3 * std::exp(0.15 * i); })}, {});
  p.products.clear();
  for (int u = 0; u < 4000; ++u) {
    p.paths.push_back({0.002 * u});
    for (int s = 0; s < 5; ++s) p.products.push_back({{{{s}, 1, u, 1.0}}, 1e-4});
  }
  const GroupFit fit = fitToTolerance(p, 1e-2, 20);
  expectSound(p, fit);
  EXPECT_LE(fit.maximum, 1e-2);
  EXPECT_LE(fit.groups.size(), 4u);
}

TEST(OpacityGroups, WrongProblemsAreRefused) {
  const SpectralProblem good = problem({per([](int) { return 1.0; })}, kRanges);
  const auto refused = [&](auto&& change) {
    SpectralProblem p = good;
    change(p);
    EXPECT_THROW(fitGroups(p, 2), std::invalid_argument);
  };
  refused([](SpectralProblem& p) { p.weight.clear(); });
  refused([](SpectralProblem& p) { p.weight[3] = NAN; });
  refused([](SpectralProblem& p) { p.weight[3] = -1.0; });
  refused([](SpectralProblem& p) { p.spectra[0].pop_back(); });
  refused([](SpectralProblem& p) { p.spectra[0][0] = INFINITY; });
  refused([](SpectralProblem& p) { p.extinction[0][0] = -1.0; });
  refused([](SpectralProblem& p) { p.paths[0].clear(); });
  refused([](SpectralProblem& p) { p.paths[0][0] = NAN; });
  refused([](SpectralProblem& p) { p.products[0].terms[0].spectrum[0] = 99; });
  refused([](SpectralProblem& p) { p.products[0].terms[0].count = 0; });
  refused([](SpectralProblem& p) { p.products[0].terms[0].path = -1; });
  refused([](SpectralProblem& p) { p.products[0].floor = NAN; });
  std::vector<SpectralGroup> foreign(1);
  EXPECT_THROW(evaluateGroups(good, foreign), std::invalid_argument);
}

}  // namespace
}  // namespace pitviper::test
