#include "sim/plan/group_step.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pitviper {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Pivots below this part of the largest are rounding: shares of a wavelength sum to 1, so that a group's averages follow from the others'.
constexpr double kNoPivot = 1e-12;

/// Equations of so many unknowns are solved at once, of more by steps, until the slope is so much smaller.
constexpr Index kMostDirect = 240;
constexpr int kMostSteps = 40;
constexpr double kNear = 3e-3;
/// Signs for an estimate of a sum of squares: to a quarter or so, which is enough for a damping that is adapted.
constexpr int kSigns = 4;

/// L L' [(shape, group), (shape, group)] = 4 sum over i of b_r b_s share_g (1(g = h) - share_h).
MatrixXd metricOf(const MatrixXd& shapes, const MatrixXd& share) {
  const Index groups = share.rows(), count = shapes.cols();
  MatrixXd spread(count * groups, share.cols());
  for (Index r = 0; r < count; ++r) spread.middleRows(r * groups, groups) = share.array().rowwise() * shapes.col(r).transpose().array();
  MatrixXd metric = MatrixXd::Zero(count * groups, count * groups);
  metric.selfadjointView<Eigen::Lower>().rankUpdate(spread, -4.0);
  for (Index r = 0; r < count; ++r)
    for (Index s = 0; s <= r; ++s) {
      const VectorXd own = 4.0 * share * shapes.col(r).cwiseProduct(shapes.col(s));
      for (Index g = 0; g < groups; ++g) metric(r * groups + g, s * groups + g) += own[g];
    }
  return metric.selfadjointView<Eigen::Lower>();
}

}  // namespace

GroupStep::GroupStep(const ProductSet& set, const GroupState& state, const GroupMoments& at, const VectorXd& errors, const VectorXd& rowWeight,
                     const VectorXd& unseen)
    : set_(set), state_(state), root_(state.share.cwiseSqrt()), slope_(state.extinction) {
  for (Index k = 0; k < slope_.cols(); ++k)
    if (unseen[k] > 0.0) slope_.col(k).array() += unseen[k];
    else slope_.col(k).setZero();
  const VectorXd rowRoot = rowWeight.cwiseSqrt();
  errors_ = errors.cwiseProduct(rowRoot);
  GroupSlopes slopes = set.slopes(at);
  slopes.average.array().rowwise() *= rowRoot.transpose().array();
  slopes.extinction.array().rowwise() *= rowRoot.transpose().array();
  slopes.extinction.array().colwise() *= slope_.reshaped().array();
  // An extinction of 0 moves only where the descent leads inwards.
  const VectorXd descent = -(slopes.extinction * errors_);
  for (Index j = 0; j < descent.size(); ++j)
    if (!(state.extinction.reshaped()[j] > 0.0 || descent[j] > 0.0)) slopes.extinction.row(j).setZero();

  slopes_ = std::move(slopes);
  isDirect_ = slopes_.average.rows() + slopes_.extinction.rows() <= kMostDirect;
  if (isDirect_) factor();
  shareCurvature_ = isDirect_ ? byRoots_.squaredNorm() : curvatureOfRoots();
}

/// The metric's factors, and slopes by v.
void GroupStep::factor() {
  const Eigen::LDLT<MatrixXd> factors(metricOf(set_.basis, state_.share));
  lower_ = factors.matrixL();
  const VectorXd pivots = factors.vectorD();
  const double least = kNoPivot * std::max(pivots.maxCoeff(), 0.0);
  rootOfPivot_ = pivots.unaryExpr([least](double d) { return d > least ? std::sqrt(d) : 0.0; });
  order_ = (factors.transpositionsP() * Eigen::VectorXi::LinSpaced(pivots.size(), 0, static_cast<int>(pivots.size()) - 1)).eval();
  MatrixXd ordered(pivots.size(), slopes_.average.cols());
  for (Index j = 0; j < ordered.rows(); ++j) ordered.row(j) = slopes_.average.row(order_[j]);
  byRoots_.noalias() = rootOfPivot_.asDiagonal() * (lower_.transpose() * ordered);
}

/// Sum of squares of the slopes by all roots: the mean over signs of |L'D's|^2 (Hutchinson 1990), here over some signs.
double GroupStep::curvatureOfRoots() const {
  std::uint64_t bits = 0x9e3779b97f4a7c15u;
  double sum = 0.0;
  for (int n = 0; n < kSigns; ++n) {
    VectorXd signs(errors_.size());
    for (Index m = 0; m < signs.size(); ++m) {
      bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
      signs[m] = bits & 1 ? 1.0 : -1.0;
    }
    sum += rootsOf(slopes_.average * signs).squaredNorm();
  }
  return sum / kSigns;
}

/// u = L'w.
MatrixXd GroupStep::rootsOf(const VectorXd& w) const {
  const MatrixXd reach = w.reshaped(root_.rows(), set_.basis.cols()) * set_.basis.transpose();
  const Eigen::RowVectorXd along = reach.cwiseProduct(state_.share).colwise().sum();
  return 2.0 * root_.cwiseProduct(reach.rowwise() - along);
}

/// z = L u.
VectorXd GroupStep::averagesOf(const MatrixXd& u) const {
  const Eigen::RowVectorXd along = u.cwiseProduct(root_).colwise().sum();
  const MatrixXd shares = 2.0 * root_.cwiseProduct(u - (root_.array().rowwise() * along.array()).matrix());
  return (shares * set_.basis).reshaped();
}

double GroupStep::curvature(double rootStep) const { return rootStep * rootStep * shareCurvature_ + slopes_.extinction.squaredNorm(); }

void GroupStep::solve(double damping, double rootStep) {
  const double shares = rootStep * rootStep;
  const Index unknowns = slopes_.average.rows() + slopes_.extinction.rows();
  const double damped = std::max(damping * curvature(rootStep) / static_cast<double>(unknowns), 1e-300);
  if (isDirect_) solveDirectly(damped / shares, damped);
  else solveBySteps(damped / shares, damped);
}

/// By unknowns, or by products where these are fewer.
void GroupStep::solveDirectly(double rootDamping, double extinctionDamping) {
  const Index shapes = byRoots_.rows(), extinctions = slopes_.extinction.rows(), all = shapes + extinctions, rows = errors_.size();
  VectorXd damped(all);
  damped << VectorXd::Constant(shapes, rootDamping), VectorXd::Constant(extinctions, extinctionDamping);
  VectorXd slope(all), step;
  slope << byRoots_ * errors_, slopes_.extinction * errors_;
  if (all <= rows) {
    if (normal_.size() == 0) {
      MatrixXd slopes(all, rows);
      slopes << byRoots_, slopes_.extinction;
      normal_ = MatrixXd::Zero(all, all);
      normal_.selfadjointView<Eigen::Lower>().rankUpdate(slopes);
    }
    MatrixXd normal = normal_;
    normal.diagonal() += damped;
    step = -normal.selfadjointView<Eigen::Lower>().llt().solve(slope);
  } else {
    if (normal_.size() == 0) {
      normal_ = normalOfExtinctions_ = MatrixXd::Zero(rows, rows);
      normal_.selfadjointView<Eigen::Lower>().rankUpdate(byRoots_.transpose());
      // Where nothing is absorbed there are none: Eigen 3.4 divides by their number where there are 48 products or more.
      if (extinctions > 0) normalOfExtinctions_.selfadjointView<Eigen::Lower>().rankUpdate(slopes_.extinction.transpose());
    }
    MatrixXd normal = normal_ / rootDamping + normalOfExtinctions_ / extinctionDamping;
    normal.diagonal().array() += 1.0;
    const VectorXd along = normal.selfadjointView<Eigen::Lower>().llt().solve(errors_);
    VectorXd turned(all);
    turned << byRoots_ * along, slopes_.extinction * along;
    step = -damped.cwiseInverse().cwiseProduct(turned);
  }
  // v to w, C'w = v.
  VectorXd w(shapes);
  for (Index j = 0; j < shapes; ++j) w[j] = rootOfPivot_[j] > 0.0 ? step[j] / rootOfPivot_[j] : 0.0;
  lower_.transpose().triangularView<Eigen::UnitUpper>().solveInPlace(w);
  VectorXd ordered(shapes);
  for (Index j = 0; j < shapes; ++j) ordered[order_[j]] = w[j];
  shareStep_ = rootsOf(ordered);
  extinctionStep_ = step.tail(extinctions).reshaped(slope_.rows(), slope_.cols());
}

/// Conjugate gradients from 0 (Hestenes and Stiefel 1952, on the normal equations), in unknowns whose damping is 1.
void GroupStep::solveBySteps(double rootDamping, double extinctionDamping) {
  const double rootScale = 1.0 / std::sqrt(rootDamping), extinctionScale = 1.0 / std::sqrt(extinctionDamping);
  struct Unknowns {
    MatrixXd roots;
    VectorXd extinctions;
    double dot(const Unknowns& o) const { return roots.cwiseProduct(o.roots).sum() + extinctions.dot(o.extinctions); }
    void add(double factor, const Unknowns& o) { roots += factor * o.roots, extinctions += factor * o.extinctions; }
  };
  const auto forward = [&](const Unknowns& x) -> VectorXd {
    return slopes_.average.transpose() * (rootScale * averagesOf(x.roots)) + slopes_.extinction.transpose() * (extinctionScale * x.extinctions);
  };
  const auto backward = [&](const VectorXd& r) -> Unknowns { return {rootScale * rootsOf(slopes_.average * r), extinctionScale * (slopes_.extinction * r)}; };
  Unknowns x{MatrixXd::Zero(root_.rows(), root_.cols()), VectorXd::Zero(slopes_.extinction.rows())};
  VectorXd rest = -errors_;
  Unknowns slope = backward(rest), direction = slope;
  double size = slope.dot(slope);
  const double enough = kNear * kNear * size;
  for (int i = 0; i < kMostSteps && size > enough; ++i) {
    const VectorXd along = forward(direction);
    const double length = size / (along.squaredNorm() + direction.dot(direction));
    x.add(length, direction);
    rest -= length * along;
    slope = backward(rest);
    slope.add(-1.0, x);
    const double next = slope.dot(slope), part = next / size;
    size = next;
    Unknowns turned = slope;
    turned.add(part, direction);
    direction = std::move(turned);
  }
  shareStep_ = rootScale * x.roots;
  extinctionStep_ = (extinctionScale * x.extinctions).reshaped(slope_.rows(), slope_.cols());
}

GroupState GroupStep::moved(double length) const {
  GroupState s;
  s.share = (root_ + length * shareStep_).cwiseAbs2();
  s.share.array().rowwise() /= s.share.colwise().sum().array();
  const auto logStep = (length * extinctionStep_).array().max(-1.0).min(1.0);
  s.extinction = (state_.extinction.array() + slope_.array() * (logStep.exp() - 1.0)).max(0.0);
  return s;
}

}  // namespace pitviper
