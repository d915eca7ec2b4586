#pragma once
// The products of a spectral problem laid out for arithmetic: fine values once, then planned values and their derivatives for any groups.
#include <Eigen/Core>
#include <vector>

#include "sim/plan/group_kernels.hpp"
#include "sim/plan/opacity_groups.hpp"

namespace pitviper {

/// Groups while they are fitted. share(g, i): part of wavelength i's weight in group g; each column sums to 1.
struct GroupState {
  Eigen::MatrixXd share;       ///< [group, fine]
  Eigen::MatrixXd extinction;  ///< [group, column]
};

/// Where the products have been brought to with a state. Groups are filled up (paddedGroups()) with such as have no weight.
struct GroupMoments {
  int groups = 0;                 ///< without those
  Eigen::MatrixXd source;         ///< [group, source]: sum of weight x share x spectrum
  Eigen::VectorXd weight;         ///< [group]
  Eigen::MatrixXd transmittance;  ///< [group, path]
};

/// Derivatives of each product's error.
struct GroupSlopes {
  Eigen::MatrixXd average;     ///< [(shape, group), product]: by sum over wavelengths of shape x share; the group runs faster
  Eigen::MatrixXd extinction;  ///< [(column, group), product]
};

/// Enough for directions of steps, which is all that the basis is for.
constexpr double kBasisError = 1e-3;

class ProductSet {
 public:
  /// Checks the problem; throws std::invalid_argument. Keeps wavelengths of weight > 0 only, spectra and paths that products use only.
  explicit ProductSet(const SpectralProblem& problem);
  ProductSet subset(const std::vector<int>& products) const;

  int fineCount() const { return static_cast<int>(weight.size()); }
  int columnCount() const { return static_cast<int>(extinction.cols()); }
  int pathCount() const { return static_cast<int>(amounts.cols()); }
  int sourceCount() const { return static_cast<int>(weighted.cols()); }
  int size() const { return static_cast<int>(fine.size()); }
  /// Some term multiplies averages.
  bool hasProducts() const;

  GroupMoments moments(const GroupState& state) const;
  /// (planned - fine) / max(|fine|, floor).
  Eigen::VectorXd errors(const GroupMoments& moments) const;
  /// Derivatives of errors().
  GroupSlopes slopes(const GroupMoments& at) const;

  int wavelengths = 0;         ///< of the problem
  std::vector<int> fineIndex;  ///< of each kept wavelength, in the problem
  Eigen::VectorXd weight;      ///< [fine]
  Eigen::MatrixXd weighted;    ///< [fine, source]: weight x spectrum
  Eigen::MatrixXd basis, mix;  ///< weighted ~ basis x mix to kBasisError of each column's norm: [fine, shape], [shape, source];
  double weightSize = 0.0;     ///< where averages are multiplied the weight is one more shape, the last: basis x weightSize
  Eigen::MatrixXd extinction;  ///< [fine, column]
  Eigen::MatrixXd amounts;     ///< [column, path]
  SparseAmounts sparse;        ///< the same
  Eigen::MatrixXd parts;       ///< [tag, product]: what terms of a tag add to `fine`; not of a subset
  Eigen::VectorXd fine;        ///< [product]: value on the fine grid
  Eigen::VectorXd scale;       ///< [product]: 1 / max(|fine|, floor), 0 where that is 0
  std::vector<ProductTerm> terms;
  std::vector<int> firstTerm;  ///< [product + 1]

 private:
  ProductSet() = default;
  void compress();
  void integrate(const std::vector<double>& floors);
};

/// Largest magnitude and 99th percentile of errors.
std::pair<double, double> errorFigures(const Eigen::VectorXd& errors);

}  // namespace pitviper
