#pragma once
// What air sends along a line of sight at all nodes of a plan at once: tables of a view, and the sky of a plan, are made of thousands of these.
#include <memory>
#include <span>
#include <vector>

#include "sim/model/spectral_node.hpp"
#include "sim/radiance/sunlit_air.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {

class DiffuseLight;
struct DiffuseMemory;

/// [station x nodes + node], as far as each station [W/(m2 sr um)]. `thermal`: emission of all extinction (as AirLight::emitted) and AirNode::source, and what
/// diffuse light of thermal sources adds or takes. Diffuse sunlight that molecules turn is with theirs, over their phase function at the
/// line's own angle.
struct NodeRadiance {
  std::vector<double> depth, thermal;
  std::vector<double> molecules, haze;  ///< over the phase functions of molecules and of AirNode::meanAsymmetry, irradiance of 1; empty: no sun
  std::vector<double> again;            ///< diffuse sunlight that haze turns, for hazeAgainPhase() and irradiance of 1; empty: none
};

/// About how sunlight is spread that haze has turned twice: moments of both are multiplied. Sunlight turned more often over this changes evenly.
inline double hazeAgainPhase(double cosScatter, double asymmetry) { return physics::henyeyGreensteinPhase(cosScatter, asymmetry * asymmetry); }

/// What lines have in common that differ in their azimuth alone.
struct SameWay {
  std::vector<double> depth, thermal;
  std::shared_ptr<DiffuseMemory> turned;
};

class NodeAir {
 public:
  /// The nodes must outlive it. `diffuse`: null: light is scattered once; `kept`: as NodeDiffuse has it.
  explicit NodeAir(std::span<const SpectralNode> nodes, std::shared_ptr<const DiffuseLight> diffuse = nullptr, bool kept = false);
  /// `way`: of lines one after the other through the same places that differ in their azimuth to the sun alone; empty at the first.
  NodeRadiance along(const SunlitAir& air, SameWay* way = nullptr) const;
  /// Radiance of a black body at every node [W/(m2 sr um)]; 0 at 0 K.
  std::vector<double> planck(double temperature_K) const;

 private:
  struct Tables;
  struct Again;
  std::shared_ptr<const Tables> tables_;
};

/// 1 - exp(-x) of each, x >= 0, as physics::oneMinusExp().
std::vector<double> lostOf(std::span<const double> x);

}  // namespace pitviper
