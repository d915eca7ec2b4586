// Products of averages: their derivatives against differences of the products themselves, for one to five spectra in a term.
#include <gtest/gtest.h>

#include <random>

#include "sim/plan/product_set.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

class Numbers {
 public:
  double operator()(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_{7};
};

constexpr int kFine = 40, kGroups = 4, kSpectra = 6;

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
  Numbers random;
  const ProductSet set(problem(random));
  GroupState state{Eigen::MatrixXd::Identity(kFine, kFine), set.extinction};
  EXPECT_LT(set.errors(set.moments(state)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ProductSet, DerivativesAreThoseOfTheProducts) {
  Numbers random;
  const ProductSet set(problem(random));
  const GroupMoments at = set.moments(stateOf(random));
  GroupMoments change = at;
  for (auto* m : {&change.source, &change.transmittance})
    for (Eigen::Index i = 0; i < m->size(); ++i) m->data()[i] = random(-1.0, 1.0);
  for (Eigen::Index i = 0; i < change.weight.size(); ++i) change.weight[i] = random(-1.0, 1.0);
  const auto moved = [&](double step) {
    GroupMoments m = at;
    m.source += step * change.source;
    m.weight += step * change.weight;
    m.transmittance += step * change.transmittance;
    return set.errors(m);
  };
  constexpr double kStep = 1e-4;
  const Eigen::VectorXd slope = (moved(kStep) - moved(-kStep)) / (2.0 * kStep), told = set.forward(at, change);
  bound("derivative of products of 1 to 5 averages against differences", (slope - told).cwiseAbs().maxCoeff() / told.cwiseAbs().maxCoeff(), 1e-6,
        "central differences: step squared");
  Eigen::VectorXd u(set.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = random(-1.0, 1.0);
  const GroupMoments back = set.backward(at, u);
  const double one = u.dot(told), other = back.source.cwiseProduct(change.source).sum() + back.weight.dot(change.weight) +
                                          back.transmittance.cwiseProduct(change.transmittance).sum();
  EXPECT_NEAR(one, other, 1e-10 * std::abs(one)) << "the transpose";
}

}  // namespace
}  // namespace pitviper::test
