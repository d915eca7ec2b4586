#pragma once
// First groups for a fit: wavelengths that stand for the others.
#include "sim/plan/product_set.hpp"

namespace pitviper {

/// What tells wavelengths apart: their transmittances on paths of the problem and, where spectra multiply after averaging, those spectra.
class GroupStart {
 public:
  explicit GroupStart(const ProductSet& set);

  /// Groups grown one by one: each new one begins at the wavelength that mixtures of the others represent worst; every wavelength is shared
  /// out over groups as the mixture that comes nearest to it. No more groups than there are different wavelengths.
  GroupState state(int groups);

 private:
  void grow();
  Eigen::VectorXd mixtureOf(Eigen::Index wavelength) const;

  Eigen::MatrixXd feature_;     ///< [feature, fine]
  Eigen::VectorXd importance_;  ///< [fine]
  Eigen::MatrixXd extinction_;  ///< [fine, column]
  std::vector<int> standIns_;   ///< wavelength of each group
  Eigen::MatrixXd gram_;        ///< between stand-ins
  Eigen::MatrixXd projection_;  ///< [stand-in, fine]
  Eigen::VectorXd misfit_;      ///< [fine], squared
  bool complete_ = false;
};

/// Shares of least squares on the simplex: minimises x'Hx/2 - b'x over x >= 0, sum of x = 1.
Eigen::VectorXd simplexLeastSquares(const Eigen::MatrixXd& gram, const Eigen::VectorXd& b);

}  // namespace pitviper
