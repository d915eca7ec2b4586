#pragma once
// Black bodies at nodes by temperature, for lines that meet thousands of temperatures: rows of temperatures evenly apart, made when they are first asked for;
// between two the cubic that has their values and slopes (Hermite's).
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "sim/radiance/node_planck.hpp"

namespace pitviper {

/// May be shared between threads.
class PlanckTable {
 public:
  PlanckTable(std::span<const SpectralNode> nodes, double first_K, double last_K, double step_K);
  /// As averages of nodes of single wavelengths, `parts`, that have a table already; null where one is missing among them.
  static std::shared_ptr<const PlanckTable> averaged(std::span<const SpectralNode> nodes, const std::shared_ptr<const PlanckTable>& parts,
                                                     std::span<const SpectralNode> partNodes);
  /// [W/(m2 sr um)] of each node; false outside the table.
  bool at(double temperature_K, std::span<double> into) const;

 private:
  PlanckTable() = default;
  /// Values and, by step, slopes of each node.
  const std::vector<double>& row(std::size_t number) const;

  double first_K_ = 0.0, step_K_ = 1.0;
  std::size_t nodes_ = 0;
  NodePlanck planck_{{}};
  std::shared_ptr<const PlanckTable> parts_;
  std::vector<std::vector<std::pair<std::size_t, double>>> of_;  ///< of each node, which parts and their shares
  mutable std::vector<std::once_flag> made_;
  mutable std::vector<std::vector<double>> rows_;
};

}  // namespace pitviper
