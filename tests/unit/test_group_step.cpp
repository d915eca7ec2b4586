// The Gauss-Newton step of groups against the same least squares solved over every share by itself.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "sim/plan/group_step.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/numbers.hpp"

namespace pitviper::test {
namespace {

constexpr int kFine = 25, kColumns = 2;
constexpr double kDamping = 0.1, kRootStep = 3.0;

SpectralProblem problem(Numbers& random, int products) {
  SpectralProblem p;
  for (int i = 0; i < kFine; ++i) p.weight.push_back(random(0.1, 1.0));
  for (int s = 0; s < 4; ++s) {
    p.spectra.emplace_back();
    for (int i = 0; i < kFine; ++i) p.spectra.back().push_back(random(0.1, 2.0));
  }
  for (int k = 0; k < kColumns; ++k) {
    p.extinction.emplace_back();
    for (int i = 0; i < kFine; ++i) p.extinction.back().push_back(random(0.0, 1.0));
  }
  for (int m = 0; m < products; ++m) {
    p.paths.push_back({random(0.0, 2.0), random(0.0, 2.0)});
    ProductTerm term;
    term.path = m, term.count = 1 + m % 3, term.spectrum = {m % 4, (m + 1) % 4, (m / 2) % 4};
    p.products.push_back({{term}, 0.0});
  }
  return p;
}

struct Steps {
  Eigen::VectorXd ours, whole;
  double curvature = 1.0;  ///< ours by that of all shares
};

/// Slopes of shares and extinctions at the beginning of the step.
Steps steps(int groups, int products) {
  Numbers random(11);
  const ProductSet set(problem(random, products));
  GroupState state{Eigen::MatrixXd(groups, kFine), Eigen::MatrixXd(groups, kColumns)};
  for (auto* m : {&state.share, &state.extinction})
    for (Eigen::Index i = 0; i < m->size(); ++i) m->data()[i] = random(0.1, 1.0);
  state.share.array().rowwise() /= state.share.colwise().sum().array();
  const GroupMoments at = set.moments(state);
  const Eigen::VectorXd errors = set.errors(at), unseen = Eigen::VectorXd::Constant(kColumns, 0.01);
  Eigen::VectorXd rowWeight(set.size());
  for (Eigen::Index m = 0; m < rowWeight.size(); ++m) rowWeight[m] = random(0.1, 1.0);
  GroupStep step(set, state, at, errors, rowWeight, unseen);
  step.solve(kDamping, kRootStep);
  constexpr double kLength = 1e-5;
  const GroupState forth = step.moved(kLength), back = step.moved(-kLength);

  // Every unknown by itself: roots of shares, off their sphere in the first place, and logarithms of extinctions.
  const GroupSlopes slopes = set.slopes(at);
  const Eigen::Index shares = state.share.size(), all = shares + state.extinction.size();
  const Eigen::MatrixXd root = state.share.cwiseSqrt();
  Eigen::MatrixXd j(set.size(), all), onto = Eigen::MatrixXd::Identity(all, all);
  for (Eigen::Index i = 0; i < kFine; ++i)
    for (Eigen::Index g = 0; g < groups; ++g) {
      Eigen::VectorXd column = Eigen::VectorXd::Zero(set.size());
      for (Eigen::Index r = 0; r < set.basis.cols(); ++r) column += 2.0 * root(g, i) * set.basis(i, r) * slopes.average.row(r * groups + g).transpose();
      j.col(i * groups + g) = column;
      for (Eigen::Index h = 0; h < groups; ++h) onto(i * groups + g, i * groups + h) -= root(g, i) * root(h, i);
    }
  const Eigen::VectorXd byLogarithm = (state.extinction.array() + 0.01).matrix().reshaped();
  for (Eigen::Index k = 0; k < state.extinction.size(); ++k) j.col(shares + k) = byLogarithm[k] * slopes.extinction.row(k).transpose();
  const Eigen::VectorXd rowRoot = rowWeight.cwiseSqrt();
  const Eigen::MatrixXd weighted = rowRoot.asDiagonal() * (j * onto);
  const double root2 = kRootStep * kRootStep;
  const double exact = root2 * weighted.leftCols(shares).squaredNorm() + weighted.rightCols(all - shares).squaredNorm();
  const double damped = kDamping * step.curvature(kRootStep) / static_cast<double>(groups * (set.basis.cols() + kColumns));
  Eigen::VectorXd diagonal(all);
  diagonal << Eigen::VectorXd::Constant(shares, damped / root2), Eigen::VectorXd::Constant(all - shares, damped);
  const Eigen::MatrixXd normal = weighted.transpose() * weighted + Eigen::MatrixXd(diagonal.asDiagonal());
  const Eigen::VectorXd u = normal.llt().solve(-(weighted.transpose() * rowRoot.cwiseProduct(errors)));
  Steps out{Eigen::VectorXd(all), Eigen::VectorXd(all), step.curvature(kRootStep) / exact};
  out.ours << ((forth.share - back.share) / (2.0 * kLength)).reshaped(), ((forth.extinction - back.extinction) / (2.0 * kLength)).reshaped();
  out.whole << 2.0 * root.reshaped().cwiseProduct(u.head(shares)), byLogarithm.cwiseProduct(u.tail(all - shares));
  return out;
}

TEST(GroupStep, IsTheDampedLeastSquaresOverAllShares) {
  // Fewer unknowns than products, and more; then so many that steps are sought.
  for (const auto& [groups, products] : {std::pair{3, 60}, {5, 12}, {50, 100}}) {
    const bool isSought = groups == 50;
    const Steps s = steps(groups, products);
    bound("step of " + std::to_string(groups) + " groups, " + std::to_string(products) + " products, against all shares by themselves",
          (s.ours - s.whole).cwiseAbs().maxCoeff() / s.whole.cwiseAbs().maxCoeff(), isSought ? 0.1 : 1e-7,
          isSought ? "conjugate gradients until the slope is 3e-3 of the first" : "the same minimum; differences of moved states");
    EXPECT_NEAR(s.curvature, 1.0, isSought ? 0.5 : 1e-9);
  }
}

TEST(GroupStep, WithoutAbsorbers) {
  // More unknowns than products, and more than 48 of these: Eigen would divide by the number of absorbers.
  Numbers random(12);
  SpectralProblem p = problem(random, 60);
  p.extinction.clear();
  for (auto& path : p.paths) path.clear();
  const ProductSet set(p);
  GroupState state{Eigen::MatrixXd(30, kFine), Eigen::MatrixXd(30, 0)};
  for (Eigen::Index i = 0; i < state.share.size(); ++i) state.share.data()[i] = random(0.1, 1.0);
  state.share.array().rowwise() /= state.share.colwise().sum().array();
  const GroupMoments at = set.moments(state);
  const Eigen::VectorXd errors = set.errors(at);
  GroupStep step(set, state, at, errors, Eigen::VectorXd::Ones(set.size()), Eigen::VectorXd());
  step.solve(kDamping, kRootStep);
  const double before = errors.squaredNorm(), after = set.errors(set.moments(step.moved(1.0))).squaredNorm();
  EXPECT_LT(after, before);
}

}  // namespace
}  // namespace pitviper::test
