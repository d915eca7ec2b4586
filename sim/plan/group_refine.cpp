#include "sim/plan/group_refine.hpp"

#include <algorithm>
#include <cmath>

#include "sim/plan/group_start.hpp"

namespace pitviper {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// An optical depth of the longest path that nobody sees: extinctions move by factors above it, by amounts below.
constexpr double kUnseenDepth = 0.02;

/// A step in the unknowns: roots of shares [group, fine] and logarithms of extinctions [group, column].
struct Step {
  MatrixXd share, extinction;

  double dot(const Step& o) const { return share.cwiseProduct(o.share).sum() + extinction.cwiseProduct(o.extinction).sum(); }
  void add(double factor, const Step& o) {
    share += factor * o.share;
    extinction += factor * o.extinction;
  }
};

/// Part of the plain sum of squares in what is minimised: keeps what is already good from drifting.
constexpr double kEven = 1e-3;

/// Mean of (|e| / unit)^p 2/p unit^2 + kEven e^2: its derivative by an error is 2 ((|e| / unit)^(p-2) + kEven) e.
double merit(const VectorXd& errors, double p, double unit) {
  const auto parts = errors.array().abs() / unit;
  return (parts.pow(p) * (2.0 / p) + kEven * parts.square()).mean();
}

/// The errors to first order about a state, in unknowns scaled so that each matters about as much as the others.
class Linear {
 public:
  Linear(const ProductSet& set, const GroupState& state, const GroupMoments& at, const VectorXd& rowWeight, const VectorXd& unseen, double damping)
      : set_(set), state_(state), at_(at), root_(rowWeight.cwiseSqrt()), shareRoot_(state.share.cwiseSqrt()), slope_(state.extinction) {
    for (Eigen::Index k = 0; k < slope_.cols(); ++k)
      slope_.col(k) = unseen[k] > 0.0 ? VectorXd(state.extinction.col(k).array() + unseen[k]) : VectorXd::Zero(slope_.rows());
    // The diagonal of J'J but for what terms of one product have in common.
    const GroupMoments sq = set.squares(at, rowWeight);
    const MatrixXd shareDiagonal = sq.source * set.weighted.cwiseAbs2().transpose();
    const MatrixXd depthSquares = sq.transmittance.cwiseProduct(at.transmittance.cwiseAbs2()) * set.amounts.cwiseAbs2().transpose();
    // Of share = root^2: derivative 2 root.
    shareScale_ = 4.0 * shareDiagonal.cwiseProduct(state.share).colwise().mean();
    // Damping holds back the unknowns themselves: a linear model knows nothing beyond some tenths of a root or of a logarithm. The scale
    // is 1 / sqrt of the diagonal with it.
    const double shareDamping = std::max(damping * shareScale_.mean(), 1e-300);
    shareScale_ = (shareScale_.array() + shareDamping).rsqrt();
    shareDamping_ = shareDamping * shareScale_.cwiseAbs2();
    extinctionScale_ = depthSquares.cwiseProduct(slope_.cwiseAbs2());
    const double extinctionDamping = std::max(extinctionScale_.size() ? damping * extinctionScale_.mean() : 0.0, 1e-300);
    extinctionScale_ = (extinctionScale_.array() + extinctionDamping).rsqrt();
    extinctionDamping_ = extinctionDamping * extinctionScale_.cwiseAbs2();
    shareSlope_ = 2.0 * (shareRoot_.array().rowwise() * shareScale_.transpose().array()).matrix();
    freeExtinction_ = MatrixXd::Ones(slope_.rows(), slope_.cols());
  }

  VectorXd forward(const Step& d) const {
    GroupMoments change;
    const MatrixXd share = d.share.cwiseProduct(shareSlope_);
    change.source.noalias() = (share * set_.basis).eval() * set_.mix;
    change.weight.noalias() = share * set_.weight;
    const MatrixXd extinction = d.extinction.cwiseProduct(extinctionScale_).cwiseProduct(slope_);
    change.transmittance.noalias() = extinction * set_.amounts;
    change.transmittance = -change.transmittance.cwiseProduct(at_.transmittance);
    return set_.forward(at_, change).cwiseProduct(root_);
  }

  Step backward(const VectorXd& u) const {
    GroupMoments sums = set_.backward(at_, u.cwiseProduct(root_));
    Step g;
    g.share.noalias() = (sums.source * set_.mix.transpose()).eval() * set_.basis.transpose();
    g.share.noalias() += sums.weight * set_.weight.transpose();
    g.share = g.share.cwiseProduct(shareSlope_);
    sums.transmittance = -sums.transmittance.cwiseProduct(at_.transmittance);
    g.extinction.noalias() = sums.transmittance * set_.amounts.transpose();
    g.extinction = g.extinction.cwiseProduct(slope_).cwiseProduct(extinctionScale_);
    project(g);
    return g;
  }

  /// An extinction of 0 moves only where the descent direction leads inwards.
  void chooseFree(const Step& descent) { freeExtinction_ = (state_.extinction.array() > 0.0 || descent.extinction.array() > 0.0).cast<double>(); }

  /// Onto steps along the sphere on which the roots of each wavelength's shares lie.
  void project(Step& d) const {
    const Eigen::RowVectorXd along = d.share.cwiseProduct(shareRoot_).colwise().sum();
    d.share -= (shareRoot_.array().rowwise() * along.array()).matrix();
    d.extinction = d.extinction.cwiseProduct(freeExtinction_);
  }

  GroupState moved(const Step& d, double length) const {
    GroupState s = state_;
    MatrixXd stepped = shareRoot_ + length * (d.share.array().rowwise() * shareScale_.transpose().array()).matrix();
    s.share = stepped.cwiseAbs2();
    s.share.array().rowwise() /= s.share.colwise().sum().array();
    // Extinction + unseen depth grows by a factor; no step by more than e.
    const auto logStep = (length * d.extinction.cwiseProduct(extinctionScale_)).array().max(-1.0).min(1.0);
    s.extinction = (s.extinction.array() + slope_.array() * (logStep.exp() - 1.0)).max(0.0);
    return s;
  }

  Step damped(const Step& d) const {
    Step r{(d.share.array().rowwise() * shareDamping_.transpose().array()).matrix(), d.extinction.cwiseProduct(extinctionDamping_)};
    project(r);
    return r;
  }

  Step zero() const { return {MatrixXd::Zero(shareRoot_.rows(), shareRoot_.cols()), MatrixXd::Zero(slope_.rows(), slope_.cols())}; }

 private:
  const ProductSet& set_;
  const GroupState& state_;
  const GroupMoments& at_;
  VectorXd root_;
  MatrixXd shareRoot_, shareSlope_;
  MatrixXd slope_;  ///< change of an extinction by its unknown
  VectorXd shareScale_, shareDamping_;
  MatrixXd extinctionScale_, extinctionDamping_, freeExtinction_;
};

/// Least squares of J d = -e with damping, by conjugate gradients from 0 (Hestenes and Stiefel 1952, on the normal equations).
Step solve(Linear& linear, const VectorXd& weightedErrors, int steps) {
  Step d = linear.zero();
  VectorXd r = -weightedErrors;
  Step s = linear.backward(r);
  linear.chooseFree(s);
  linear.project(s);
  Step p = s;
  double gamma = s.dot(s);
  const double first = gamma;
  for (int i = 0; i < steps && gamma > 1e-12 * first && gamma > 0.0; ++i) {
    const VectorXd q = linear.forward(p);
    const double curvature = q.squaredNorm() + p.dot(linear.damped(p));
    if (!(curvature > 0.0)) break;
    const double alpha = gamma / curvature;
    d.add(alpha, p);
    r -= alpha * q;
    s = linear.backward(r);
    s.add(-1.0, linear.damped(d));
    const double next = s.dot(s), beta = next / gamma;
    gamma = next;
    p.share = s.share + beta * p.share;
    p.extinction = s.extinction + beta * p.extinction;
  }
  return d;
}

}  // namespace

double refineGroups(const ProductSet& set, GroupState& state, RefineProgress& progress, const RefineLimits& limits) {
  GroupMoments at = set.moments(state);
  VectorXd errors = set.errors(at);
  double most = errorFigures(errors).first;
  GroupState best = state;
  if (state.share.rows() < 1 || set.size() == 0) return most;
  VectorXd unseen(set.columnCount());
  for (Eigen::Index k = 0; k < unseen.size(); ++k) {
    const double longest = set.pathCount() ? set.amounts.row(k).maxCoeff() : 0.0;
    unseen[k] = longest > 0.0 && set.extinction.col(k).maxCoeff() > 0.0 ? kUnseenDepth / longest : 0.0;
  }
  double& damping = progress.damping;
  for (int round = 0; round < limits.rounds && most > limits.goal && !limits.expired(); ++round, ++progress.round) {
    const double p = std::clamp(2.0 * std::pow(1.25, progress.round - 4), 2.0, 16.0);
    const double largest = errors.cwiseAbs().maxCoeff();
    if (!(largest > 0.0)) break;
    // Newton's step on the p-norm: rows weighted with |e|^(p-2); a small part for all keeps the good ones good.
    VectorXd rowWeight = (errors.array().abs() / largest).pow(p - 2.0) + kEven;
    rowWeight /= rowWeight.sum();
    Linear linear(set, state, at, rowWeight, unseen, damping);
    const Step d = solve(linear, errors.cwiseProduct(rowWeight.cwiseSqrt()), limits.innerSteps);
    const double before = merit(errors, p, largest);
    double after = before;
    GroupState moved;
    GroupMoments movedAt;
    VectorXd movedErrors;
    double taken = 0.0;
    for (double length : {1.0, 0.5, 0.25, 0.12, 0.06, 0.03}) {
      GroupState trial = linear.moved(d, length);
      GroupMoments trialAt = set.moments(trial);
      VectorXd trialErrors = set.errors(trialAt);
      const double value = merit(trialErrors, p, largest);
      if (!(value < after)) {
        if (taken > 0.0) break;
        continue;
      }
      after = value;
      taken = length;
      moved = std::move(trial);
      movedAt = std::move(trialAt);
      movedErrors = std::move(trialErrors);
    }
    if (taken == 0.0) {
      damping = std::min(damping * 10.0, 1e3);
      continue;
    }
    // Newton's step on the p-norm is 1 / (p - 1) of this one; much less says that the model is wrong so far out.
    const double newton = 1.0 / (p - 1.0);
    damping = std::clamp(damping * (taken >= std::min(2.0 * newton, 1.0) ? 0.4 : taken >= 0.9 * newton ? 1.0 : 4.0), 1e-6, 1e4);
    state = std::move(moved);
    at = std::move(movedAt);
    errors = std::move(movedErrors);
    const double reached = errorFigures(errors).first;
    if (reached < most) {
      most = reached;
      best = state;
    }
  }
  state = std::move(best);
  return most;
}

}  // namespace pitviper
