#pragma once
// What air sends along a line of sight at all nodes of a plan at once: tables of a view, and the sky of a plan, are made of thousands of these.
#include <memory>
#include <span>
#include <vector>

#include "sim/model/spectral_node.hpp"
#include "sim/radiance/sunlit_air.hpp"

namespace pitviper {

/// [station x nodes + node], as far as each station [W/(m2 sr um)]. `thermal`: emission of all extinction (as AirLight::emitted) and AirNode::source.
struct NodeRadiance {
  std::vector<double> depth, thermal;
  std::vector<double> molecules, haze;  ///< for phase functions and irradiance of 1; empty: no sun
};

class NodeAir {
 public:
  /// The nodes must outlive it.
  explicit NodeAir(std::span<const SpectralNode> nodes);
  NodeRadiance along(const SunlitAir& air) const;
  /// Radiance of a black body at every node [W/(m2 sr um)]; 0 at 0 K.
  std::vector<double> planck(double temperature_K) const;

 private:
  struct Tables;
  std::shared_ptr<const Tables> tables_;
};

/// 1 - exp(-x) of each, x >= 0, as physics::oneMinusExp().
std::vector<double> lostOf(std::span<const double> x);

}  // namespace pitviper
