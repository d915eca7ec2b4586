#include "sim/plan/group_start.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// More would only cost time: neighbouring paths say the same.
constexpr Eigen::Index kMostPaths = 80;
constexpr Eigen::Index kMostSpectra = 24;

/// Squared misfit relative to the feature's mean square below which a wavelength counts as represented.
constexpr double kSame = 1e-24;

std::vector<Eigen::Index> spread(Eigen::Index count, Eigen::Index most) {
  std::vector<Eigen::Index> picked;
  const Eigen::Index n = std::min(count, most);
  for (Eigen::Index j = 0; j < n; ++j) picked.push_back(j * count / n);
  return picked;
}

}  // namespace

// Active sets: equality-constrained minimum on the free variables, stepping to the first bound it would cross (Nocedal and Wright, ch. 16.5).
Eigen::VectorXd simplexLeastSquares(const Eigen::MatrixXd& gram, const Eigen::VectorXd& b) {
  const Eigen::Index n = b.size();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  Eigen::Index start = 0;
  (0.5 * gram.diagonal() - b).minCoeff(&start);
  x[start] = 1.0;
  std::vector<Eigen::Index> freeSet{start};
  const double ridge = 1e-12 * gram.diagonal().maxCoeff() + 1e-300;
  for (Eigen::Index round = 0; round < 4 * n + 8; ++round) {
    const auto f = static_cast<Eigen::Index>(freeSet.size());
    Eigen::MatrixXd h(f, f);
    Eigen::MatrixXd right(f, 2);
    for (Eigen::Index i = 0; i < f; ++i) {
      for (Eigen::Index j = 0; j < f; ++j) h(i, j) = gram(freeSet[static_cast<size_t>(i)], freeSet[static_cast<size_t>(j)]);
      h(i, i) += ridge;
      right(i, 0) = b[freeSet[static_cast<size_t>(i)]];
      right(i, 1) = 1.0;
    }
    const Eigen::MatrixXd solved = h.ldlt().solve(right);
    const double total = solved.col(1).sum();
    if (!std::isfinite(total) || total <= 0.0) break;
    const Eigen::VectorXd target = solved.col(0) + solved.col(1) * ((1.0 - solved.col(0).sum()) / total);
    double step = 1.0;
    Eigen::Index blocking = -1;
    for (Eigen::Index i = 0; i < f; ++i) {
      const double from = x[freeSet[static_cast<size_t>(i)]];
      if (target[i] < 0.0 && from / (from - target[i]) < step) {
        step = from / (from - target[i]);
        blocking = i;
      }
    }
    for (Eigen::Index i = 0; i < f; ++i) {
      double& v = x[freeSet[static_cast<size_t>(i)]];
      v = std::max(v + step * (target[i] - v), 0.0);
    }
    if (blocking >= 0) {
      x[freeSet[static_cast<size_t>(blocking)]] = 0.0;
      freeSet.erase(freeSet.begin() + blocking);
      continue;
    }
    // At the minimum on the free set all free gradients are alike; a bound variable with a smaller one may enter.
    const Eigen::VectorXd gradient = gram * x - b;
    const double level = x.dot(gradient);
    Eigen::Index entering = -1;
    double least = level - 1e-9 * (std::abs(level) + b.cwiseAbs().maxCoeff());
    for (Eigen::Index i = 0; i < n; ++i)
      if (x[i] == 0.0 && gradient[i] < least && std::find(freeSet.begin(), freeSet.end(), i) == freeSet.end()) {
        least = gradient[i];
        entering = i;
      }
    if (entering < 0) break;
    freeSet.push_back(entering);
  }
  return x / x.sum();
}

GroupStart::GroupStart(const ProductSet& set) : extinction_(set.extinction) {
  const Eigen::Index n = set.fineCount();
  // What a wavelength matters: its part of the sources, each taken as one.
  importance_ = Eigen::VectorXd::Zero(n);
  for (Eigen::Index s = 0; s < set.weighted.cols(); ++s) {
    const double total = set.weighted.col(s).cwiseAbs().sum();
    if (total > 0.0) importance_ += set.weighted.col(s).cwiseAbs() / total;
  }
  // Where no source shines a wavelength still belongs somewhere.
  importance_ = importance_ / std::max(importance_.sum(), 1e-300) + 1e-6 * set.weight / std::max(set.weight.sum(), 1e-300);

  const auto paths = spread(set.pathCount(), kMostPaths);
  std::vector<Eigen::Index> spectra;
  if (set.hasProducts()) {
    std::vector<bool> used(static_cast<size_t>(set.sourceCount()), false);
    for (const ProductTerm& t : set.terms)
      for (int f = 0; t.count > 1 && f < t.count; ++f) used[static_cast<size_t>(t.spectrum[static_cast<size_t>(f)])] = true;
    std::vector<Eigen::Index> all;
    for (size_t s = 0; s < used.size(); ++s)
      if (used[s]) all.push_back(static_cast<Eigen::Index>(s));
    for (Eigen::Index j : spread(static_cast<Eigen::Index>(all.size()), kMostSpectra)) spectra.push_back(all[static_cast<size_t>(j)]);
  }
  const auto pathRows = static_cast<Eigen::Index>(paths.size()), spectrumRows = static_cast<Eigen::Index>(spectra.size());
  feature_ = Eigen::MatrixXd::Zero(pathRows + spectrumRows, n);
  for (Eigen::Index j = 0; j < pathRows; ++j) {
    const Eigen::ArrayXd tau = (-(set.extinction * set.amounts.col(paths[static_cast<size_t>(j)])).array()).exp();
    // Errors are relative to what gets through, or to what is emitted; a path that shows nothing of either gets no more weight than 1 in 1000.
    const double mean = (tau * importance_.array()).sum() / importance_.sum();
    const double size = std::max(std::min(mean, 1.0 - mean), 1e-3);
    feature_.row(j) = (tau / size / std::sqrt(static_cast<double>(pathRows))).matrix().transpose();
  }
  for (Eigen::Index j = 0; j < spectrumRows; ++j) {
    const Eigen::ArrayXd s = set.weighted.col(spectra[static_cast<size_t>(j)]).array() / set.weight.array();
    const double mean = (s.abs() * importance_.array()).sum() / importance_.sum();
    if (mean > 0.0) feature_.row(pathRows + j) = (s / mean / std::sqrt(static_cast<double>(spectrumRows))).matrix().transpose();
  }
  misfit_ = Eigen::VectorXd::Constant(n, INFINITY);
}

Eigen::VectorXd GroupStart::mixtureOf(Eigen::Index wavelength) const { return simplexLeastSquares(gram_, projection_.col(wavelength)); }

void GroupStart::grow() {
  const Eigen::Index n = feature_.cols();
  Eigen::Index next = 0;
  if (standIns_.empty()) {
    // The first: nearest to the mean.
    const Eigen::VectorXd mean = feature_ * importance_ / importance_.sum();
    (feature_.colwise() - mean).colwise().squaredNorm().minCoeff(&next);
  } else {
    // With the importance itself the last per cent of a band would never be looked at; its root keeps faint wavelengths in sight.
    (misfit_.array() * importance_.array().sqrt()).maxCoeff(&next);
    if (misfit_[next] <= kSame * std::max(feature_.squaredNorm() / static_cast<double>(n), 1e-300)) {
      complete_ = true;
      return;
    }
  }
  standIns_.push_back(static_cast<int>(next));
  const auto g = static_cast<Eigen::Index>(standIns_.size());
  projection_.conservativeResize(g, n);
  projection_.row(g - 1) = feature_.col(next).transpose() * feature_;
  gram_.resize(g, g);
  for (Eigen::Index i = 0; i < g; ++i)
    for (Eigen::Index j = 0; j < g; ++j) gram_(i, j) = projection_(i, standIns_[static_cast<size_t>(j)]);
  Eigen::MatrixXd ends(feature_.rows(), g);
  for (Eigen::Index i = 0; i < g; ++i) ends.col(i) = feature_.col(standIns_[static_cast<size_t>(i)]);
  for (Eigen::Index i = 0; i < n; ++i) misfit_[i] = misfit_[i] > 0.0 ? (feature_.col(i) - ends * mixtureOf(i)).squaredNorm() : 0.0;
  for (int s : standIns_) misfit_[s] = 0.0;
}

GroupState GroupStart::state(int groups) {
  while (static_cast<int>(standIns_.size()) < groups && !complete_) grow();
  const Eigen::Index g = std::min(static_cast<Eigen::Index>(groups), static_cast<Eigen::Index>(standIns_.size()));
  GroupState s{Eigen::MatrixXd::Zero(g, feature_.cols()), Eigen::MatrixXd(g, extinction_.cols())};
  for (Eigen::Index i = 0; i < g; ++i) s.extinction.row(i) = extinction_.row(standIns_[static_cast<size_t>(i)]);
  const Eigen::MatrixXd gram = gram_.topLeftCorner(g, g);
  for (Eigen::Index i = 0; i < feature_.cols(); ++i) s.share.col(i) = simplexLeastSquares(gram, projection_.col(i).head(g));
  return s;
}

}  // namespace pitviper
