#pragma once
// One damped Gauss-Newton step of all groups' shares and extinctions together.
//
// Unknowns: steps u(g, i) of the roots of shares, tangential to the sphere on which the roots of a wavelength's shares lie, and steps y(g, k) of
// logarithms of extinctions. Minimised: sum over products of weight (e + D z + E y)^2 + mu |u|^2 + nu |y|^2, where the errors e know the shares
// only by z(g, r) = sum over i of b_r(i) 2 root(g, i) u(g, i): averages of few shapes b_r, and of the weight itself. So u is sought among
// L'w alone, z = L u (a step outside of them costs and changes nothing), and with L L' = C C' the unknowns are v, z = C v, |u| = |v|: as many as
// groups times shapes, not groups times wavelengths.
#include <vector>

#include "sim/plan/product_set.hpp"

namespace pitviper {

class GroupStep {
 public:
  /// `rowWeight` of each product's squared error; `unseen`: an extinction of each column that nobody sees, above which steps are by factors;
  /// 0: the column does not move.
  GroupStep(const ProductSet& set, const GroupState& state, const GroupMoments& at, const Eigen::VectorXd& errors, const Eigen::VectorXd& rowWeight,
            const Eigen::VectorXd& unseen);

  /// With a damping relative to the mean curvature, Levenberg and Marquardt's. `rootStep`: how far a root of a share may go where an extinction goes by a
  /// factor of e.
  void solve(double damping, double rootStep);
  /// Sum of squares of the slopes by all unknowns, each in its natural step; where they are many an estimate.
  double curvature(double rootStep) const;
  /// Another solve() costs little.
  bool isCheap() const { return isDirect_; }
  /// The state a part of the step further on, shares put back onto their sphere, extinctions onto 0 and above, none by more than a factor of e.
  GroupState moved(double length) const;

 private:
  void factor();
  double curvatureOfRoots() const;
  Eigen::MatrixXd rootsOf(const Eigen::VectorXd& w) const;
  Eigen::VectorXd averagesOf(const Eigen::MatrixXd& u) const;
  void solveDirectly(double rootDamping, double extinctionDamping);
  void solveBySteps(double rootDamping, double extinctionDamping);

  const ProductSet& set_;
  const GroupState& state_;
  Eigen::MatrixXd root_;         ///< of shares [group, fine]
  Eigen::MatrixXd slope_;        ///< change of an extinction by its unknown [group, column]; 0: it does not move
  Eigen::VectorXd errors_;       ///< weighted, as the slopes are
  GroupSlopes slopes_;           ///< by z, and by y
  bool isDirect_ = false;        ///< few unknowns: with
  Eigen::MatrixXd lower_;        ///< L of L D L' = P (L L') P',
  Eigen::VectorXd rootOfPivot_;  ///< the root of D, 0 where it is nothing but rounding,
  Eigen::VectorXi order_;        ///< P: [place] -> (shape, group), and
  Eigen::MatrixXd byRoots_;      ///< slopes by v [v, product]
  Eigen::MatrixXd normal_,
      normalOfExtinctions_;      ///< sums of products of slopes by unknowns, or by products and by the two kinds of unknowns; made when asked for
  double shareCurvature_ = 0.0;  ///< sum of squares of the slopes by roots
  Eigen::MatrixXd shareStep_, extinctionStep_;
};

}  // namespace pitviper
