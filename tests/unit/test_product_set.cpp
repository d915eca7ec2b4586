// Products of averages: their derivatives against differences of the products themselves, for one to five spectra in a term.
#include <gtest/gtest.h>

#include <tuple>

#include "sim/parameters/on_threads.hpp"
#include "sim/plan/product_set.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/numbers.hpp"

namespace pitviper::test {
namespace {

constexpr int kFine = 40, kGroups = 5, kSpectra = 6;

SpectralProblem problem(Numbers& random) {
  SpectralProblem p;
  for (int i = 0; i < kFine; ++i) p.weight.push_back(random(0.1, 1.0));
  for (int s = 0; s < kSpectra; ++s) {
    p.spectra.emplace_back();
    for (int i = 0; i < kFine; ++i) p.spectra.back().push_back(random(0.1, 2.0));
  }
  for (int k = 0; k < 2; ++k) {
    p.extinction.emplace_back();
    for (int i = 0; i < kFine; ++i) p.extinction.back().push_back(random(0.0, 1.0));
  }
  for (int u = 0; u < 3; ++u) p.paths.push_back({random(0.0, 1.0), random(0.0, 1.0)});
  for (int count = 1; count <= 5; ++count)
    for (int u = 0; u < 3; ++u) {
      SpectralProduct product;
      for (int t = 0; t < 2; ++t) {
        ProductTerm term;
        term.count = count, term.path = u, term.coefficient = random(-1.0, 2.0);
        for (int f = 0; f < count; ++f) term.spectrum[static_cast<size_t>(f)] = (f + t + u) % kSpectra;
        // The same pane twice on a way, as a shell is passed.
        if (count == 4) term.spectrum[3] = term.spectrum[2];
        product.terms.push_back(term);
      }
      product.floor = 1.0;
      p.products.push_back(product);
    }
  return p;
}

GroupState stateOf(Numbers& random) {
  GroupState s{Eigen::MatrixXd(kGroups, kFine), Eigen::MatrixXd(kGroups, 2)};
  for (auto* m : {&s.share, &s.extinction})
    for (Eigen::Index i = 0; i < m->size(); ++i) m->data()[i] = random(0.1, 1.0);
  s.share.array().rowwise() /= s.share.colwise().sum().array();
  return s;
}

// With as many groups as wavelengths every product is its fine value, however many spectra meet in it.
TEST(ProductSet, EveryWavelengthByItselfIsExact) {
  Numbers random(7);
  const ProductSet set(problem(random));
  GroupState state{Eigen::MatrixXd::Identity(kFine, kFine), set.extinction};
  EXPECT_LT(set.errors(set.moments(state)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ProductSet, DerivativesAreThoseOfTheProducts) {
  Numbers random(7);
  const ProductSet set(problem(random));
  const GroupState at = stateOf(random);
  GroupState change = at;
  for (auto* m : {&change.share, &change.extinction})
    for (Eigen::Index i = 0; i < m->size(); ++i) m->data()[i] = random(-1.0, 1.0);
  const auto moved = [&](double step) { return set.errors(set.moments({at.share + step * change.share, at.extinction + step * change.extinction})); };
  constexpr double kStep = 1e-4;
  const GroupSlopes slopes = set.slopes(set.moments(at));
  const Eigen::MatrixXd averages = change.share * set.basis;
  const Eigen::VectorXd slope = (moved(kStep) - moved(-kStep)) / (2.0 * kStep),
                        told = slopes.average.transpose() * averages.reshaped() + slopes.extinction.transpose() * change.extinction.reshaped();
  bound("derivative of products of 1 to 5 averages against differences", (slope - told).cwiseAbs().maxCoeff() / told.cwiseAbs().maxCoeff(), 3e-3,
        "spectra as few shapes, to 1e-3 of each");
}

// On however many threads: each number is worked out by one of them, in one order.
TEST(ProductSet, IsTheSameOnAnyNumberOfThreads) {
  Numbers random(77);
  SpectralProblem p = problem(random);
  const auto few = p.products;
  for (int n = 0; n < 60; ++n)
    for (SpectralProduct product : few) {
      for (ProductTerm& t : product.terms) t.coefficient *= random(0.5, 1.5);
      p.products.push_back(product);
    }
  GroupState state{Eigen::MatrixXd(kGroups, kFine), Eigen::MatrixXd(kGroups, 2)};
  for (Eigen::Index i = 0; i < kFine; ++i) {
    for (Eigen::Index g = 0; g < kGroups; ++g) state.share(g, i) = random(0.1, 1.0);
    state.share.col(i) /= state.share.col(i).sum();
  }
  for (Eigen::Index g = 0; g < kGroups; ++g) state.extinction.row(g) << random(0.0, 1.0), random(0.0, 1.0);
  const auto told = [&] {
    const ProductSet set(p);
    const GroupMoments at = set.moments(state);
    const GroupSlopes slopes = set.slopes(at);
    return std::tuple(set.fine, at.source, at.transmittance, set.errors(at), slopes.average, slopes.extinction);
  };
  const auto all = told();
  startedThreads += 1000;  // as if all cores were busy
  const auto one = told();
  startedThreads -= 1000;
  EXPECT_TRUE(all == one);
}

}  // namespace
}  // namespace pitviper::test
