#pragma once
// The groups of wavelengths of one channel, or of alike ones (kernel_family.hpp) in common: fitted to some lines of sight, checked on ever new ones.
#include "sim/plan/sights.hpp"

namespace pitviper {

class ChannelFit {
 public:
  /// `accuracy`: relative error that may be spent.
  ChannelFit(const Simulation& simulation, std::span<const Spectrum* const> kernels, double accuracy);
  /// Fits groups to all sights drawn so far. `floors`: the least that a line counts as in each kernel where its error is relative to it.
  void begin(const Sights& sights, std::vector<double> floors);
  /// Checks the groups on the sights drawn since it last looked; where they are not within the accuracy, learns the worst and fits again.
  /// True where they were.
  bool check(const Sights& sights);
  /// Adds the sights from number `first` on to those it fits to, and fits again. Where the groups were within the accuracy on them already, it asks for that
  /// `part` of the accuracy from here on. check() is due again.
  void learn(const Sights& sights, size_t first, double part);
  /// Undoes the last learn().
  void goBack();
  bool holds() const { return holds_; }

  const FineGrid& grid() const { return grid_; }
  const std::vector<int>& absorbers() const { return absorbers_; }          ///< columns of the groups' extinction: see Sights::absorbers
  const std::vector<SpectralGroup>& groups() const { return fit_.groups; }  ///< members: wavelengths of the grid
  /// By kind of term, the greatest part it made up of a line looked at (0.1: a tenth), in any kernel.
  const std::vector<double>& shares() const { return shares_; }
  /// A group's weight in a kernel.
  double weightOf(const SpectralGroup& group, size_t kernel) const;

 private:
  SpectralProblem problemOf(const Sights& sights, size_t first) const;
  void look(const ProductSet& products);
  void fit(SpectralProblem problem);

  FineGrid grid_;
  std::vector<size_t> kernels_ = {0};  ///< that are fitted: those that differ by more than a factor
  std::vector<int> absorbers_;
  double accuracy_;
  std::vector<double> floors_;
  std::vector<SpectralProduct> training_;
  std::vector<double> shares_ = std::vector<double>(kTermKinds, 0.0);
  size_t seen_ = 0;
  GroupFit fit_;
  std::pair<GroupFit, double> before_;  ///< it learnt last: groups and accuracy
  bool holds_ = false;
};

}  // namespace pitviper
