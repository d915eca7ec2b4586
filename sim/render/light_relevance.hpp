#pragma once
// Which point lights can matter to which bodies, and to what distance their shadows do: the others cost nothing.
#include <optional>
#include <vector>

#include "sim/render/tables.hpp"

namespace pitviper {

class LightRelevance {
 public:
  LightRelevance(const Simulation& simulation, const Plan& plan, const RenderTables& tables);
  /// The temperatures of the same tables have changed.
  void follow(const RenderTables& tables);
  /// False where a light is dark, or where the most that a body can reflect of it anywhere is, at every wavelength and for all lights
  /// together, below what single precision can tell from the radiance that its surfaces have by themselves: E f_max < 6e-8 / lights x S.
  bool matters(std::size_t entity, std::size_t light, const WorldState& state) const;
  /// The square of the distance from a light beyond which its shadows on a body don't matter [m2]: unshaded it is, for all lights together, less than
  /// kShadowShare of the accuracy asked for; without one, as above.
  double shadowReach2_m2(std::size_t entity, std::size_t light, const WorldState& state) const;
  /// Whether the body comes as near.
  bool shadowMatters(std::size_t entity, std::size_t light, const WorldState& state) const;

 private:
  /// What a lit part reflects and emits at each node, whatever its temperature.
  struct Part {
    std::size_t draw = 0;
    std::vector<double> most;         ///< of a point light's intensity sent on, f_max [1/sr]
    std::vector<double> emissivity;   ///< least, of tables over angles and of textures; empty: a row holds the radiance by itself
    std::vector<double> byAmbient;    ///< with `emissivity`: f_max by the ambient light that the part reflects, at its least [m2 sr um/W]; no dome: infinite
    std::optional<double> coldest_K;  ///< of a texture of temperatures
  };
  Part partOf(const Plan& plan, const RenderTables& tables, std::size_t draw) const;
  /// f_max / S at a node, S: the radiance that the part has by itself.
  double reflection(const Part& part, std::size_t node, const RenderTables& tables) const;
  double nearest2_m2(std::size_t entity, std::size_t light, const WorldState& state) const;
  double share(double part) const { return part / static_cast<double>(simulation_.lights.size()); }
  double strength_m2(std::size_t entity, std::size_t light, const WorldState& state) const {
    return state.lightLevels[light] > 0.0 ? state.lightLevels[light] * ratio_[entity * simulation_.lights.size() + light] : 0.0;
  }
  const Simulation& simulation_;
  std::vector<SpectralNode> nodes_;
  double accuracy_;
  std::vector<Part> parts_;
  std::vector<double> intensity_;  ///< [light][node], level 1
  std::vector<double> ratio_;      ///< [entity][light]: greatest f_max I / S over nodes and surfaces at level 1 [m2]; 0: reflects none of it
};

}  // namespace pitviper
