#pragma once
// Opacity groups: a channel's integral over wavelength as a sum over few groups of wavelengths that air and gases dim alike.
//
// Law: integral of S(lambda) s(lambda) exp(-sum over k of c_k(lambda) U_k) dlambda  ~  sum over g of w_g <s>_g exp(-sum over k of C_gk U_k),
//   or with a product of averages in the place of <s>_g where several spectra meet that are averaged apart,
//   <s>_g = sum over the group's members i of a share p_gi times s(lambda_i),  p_gi >= 0, sum over i of p_gi = 1.
//   S response; s source (emitted or reflected spectrum); c_k extinction per amount U_k of an absorber on the path (an amount already raised to
//   its power, or the thickness of a gas); w_g weight of the group [as the fine weights]; C_gk >= 0 its extinction, fitted.
// The averages are linear and alike for every spectrum, so that what adds up to one at every wavelength (emissivity, reflectance,
// transmittance) does so in every group, and a spectrum that comes later only needs to be averaged. Each wavelength's weight is shared out
// whole, sum over g of w_g p_gi = w_i: without absorbers every source is integrated as on the fine grid.
// This is the correlated-k idea (Goody et al. 1989, J. Quant. Spectrosc. Radiat. Transfer 42, 539) with the groups fitted to the scene's own
// products, several absorbers at once, instead of sorted by the strength of one.
// What the error is: the largest relative difference from the fine sum over the products given; evaluateGroups() tells it for others.
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace pitviper {

/// Spectra that are multiplied after averaging: a light, a reflectance, and each pane on the way.
constexpr int kMostFactors = 8;

/// coefficient x product of <spectrum> x transmittance of a path.
struct ProductTerm {
  std::array<int, kMostFactors> spectrum{};  ///< the first `count` of them
  int count = 1;
  int path = 0;
  double coefficient = 1.0;
  int tag = 0;  ///< what it is of; says nothing to a fit
  std::span<const int> spectra() const { return {spectrum.data(), static_cast<size_t>(count)}; }
};

class ProductSet;

/// Terms that add up, and may cancel (path radiance is a sum of B(T_j) (tau_j - tau_j+1)).
struct SpectralProduct {
  std::vector<ProductTerm> terms;
  double floor = 0.0;  ///< error = |planned - fine| / max(|fine|, floor); 0 where both are 0
};

struct SpectralProblem {
  std::vector<double> wavelength_um;            ///< for the reader's eyes; the fit does not look at it
  std::vector<double> weight;                   ///< response x width of each fine wavelength, >= 0
  std::vector<std::vector<double>> spectra;     ///< [source][fine]
  std::vector<std::vector<double>> extinction;  ///< [column][fine], >= 0
  std::vector<std::vector<double>> paths;       ///< [path][column], amounts U_k >= 0
  std::vector<SpectralProduct> products;
};

struct SpectralGroup {
  std::vector<std::pair<int, double>> members;  ///< fine wavelength and share > 0; the shares sum to 1
  double weight = 0.0;
  std::vector<double> extinction;  ///< per column
  bool operator==(const SpectralGroup&) const = default;
};

struct GroupFit {
  std::vector<SpectralGroup> groups;
  double maximum = 0.0, p99 = 0.0;  ///< relative error over the products: largest, and 99th percentile
};

/// How much work a fit may take. The result depends on these alone unless budget_s is set.
struct FitEffort {
  int rounds = 40;            ///< Gauss-Newton steps per fit
  int workingProducts = 600;  ///< products in a fit at first; the worst of the others join them as it goes on
  double budget_s = 0.0;      ///< stop improving after so much time; 0: no clock
  int fewGroups = 0;          ///< beyond so many groups rounds get fewer as groups get more, and counts are not told apart to one; 0: never
};

/// The best of a given count of groups; never more than there are wavelengths of weight > 0. Throws std::invalid_argument where sizes do not
/// match, an index is out of range, or a value is not finite or negative where it may not be.
GroupFit fitGroups(const SpectralProblem& problem, int groups, const FitEffort& effort = {});

/// The fewest groups found, from `fewest` on, whose largest error is within the tolerance; where more than `mostGroups` would be needed, bins of
/// neighbouring wavelengths, down to every wavelength by itself.
GroupFit fitToTolerance(const SpectralProblem& problem, double tolerance, int mostGroups, const FitEffort& effort = {}, int fewest = 1);
/// The same, beginning with groups that a fit of some other products of this problem found: as many at least.
GroupFit fitToTolerance(const ProductSet& products, double tolerance, int mostGroups, const FitEffort& effort, const std::vector<SpectralGroup>& from);

/// Error of groups over the products of another problem on the same wavelengths and columns.
GroupFit evaluateGroups(const SpectralProblem& fresh, const std::vector<SpectralGroup>& groups);

/// (planned - fine) / max(|fine|, floor) of each product.
std::vector<double> groupErrors(const ProductSet& products, const std::vector<SpectralGroup>& groups);

}  // namespace pitviper
