#pragma once
// Black bodies at nodes, for tables over thousands of temperatures: all members of all nodes at once, in vectors.
#include <span>
#include <vector>

#include "sim/model/spectral_node.hpp"

namespace pitviper {

class NodePlanck {
 public:
  explicit NodePlanck(std::span<const SpectralNode> nodes);
  /// [W/(m2 sr um)] and, where asked for, its rise with temperature [W/(m2 sr um K)], by node; temperature above 0.
  void at(double temperature_K, std::span<double> radiance, std::span<double> rise = {}) const;

 private:
  std::vector<double> c2OverWavelength_K_, c1OverWavelength5_;  ///< by member, the latter times its share
  std::vector<std::size_t> members_;                            ///< of each node
  double least_K_ = 0.0;                                        ///< of the longest wavelength
};

}  // namespace pitviper
