#pragma once
// Which point lights can matter to which bodies, and to what distance their shadows do: the others cost nothing.
#include <optional>
#include <vector>

#include "sim/render/assembly/tables.hpp"

namespace pitviper {

/// Cosine between a normal and the sun from which on a place is in full sunshine; sim/render/surface/glsl/light_demand.glsl has it too.
constexpr double kSunlit = 0.3;

class LightRelevance {
 public:
  LightRelevance(const Simulation& simulation, const Plan& plan, const RenderTables& tables);
  /// The temperatures of the same tables have changed.
  void follow(const RenderTables& tables);
  /// The square of the distance from a light beyond which a body reflects so little of it that it does not matter [m2]: in every channel and for all lights
  /// together less than budget::kLamps of the accuracy asked for of the radiance that its surfaces have by themselves; without an accuracy, at every wavelength
  /// less than what single precision can tell (6e-8). 0: it is dark. `sunlit`: in full sunshine, of which surfaces that send it on alike to all sides reflect
  /// more; within kSunlit of the horizon that counts as none.
  double reach2_m2(std::size_t entity, std::size_t light, const WorldState& state, bool sunlit = false) const;
  /// Whether the body comes as near.
  bool matters(std::size_t entity, std::size_t light, const WorldState& state) const;
  /// The square of the distance from a light beyond which its shadows on a body don't matter [m2]: unshaded it is, for all lights together, less than
  /// budget::kLampShadows of the accuracy asked for; without one, as above.
  double shadowReach2_m2(std::size_t entity, std::size_t light, const WorldState& state) const;
  /// Whether the body comes as near.
  bool shadowMatters(std::size_t entity, std::size_t light, const WorldState& state) const;

 private:
  /// What a lit part reflects and emits at each node, whatever its temperature.
  struct Part {
    std::size_t draw = 0;
    std::vector<double> most;        ///< of a point light's intensity sent on, f_max [1/sr]
    std::vector<double> emissivity;  ///< least, of tables over angles and of textures; empty: a row holds the radiance by itself
    std::vector<double> byAmbient;   ///< with `emissivity`: f_max by the ambient light that the part reflects, at its least [m2 sr um/W]; no dome: infinite
    std::vector<std::vector<double>> component;  ///< what each sends on, where all do so alike to all sides [1/sr]; else empty
    std::optional<double> coldest_K;             ///< of a texture of temperatures
  };
  Part partOf(const Plan& plan, const RenderTables& tables, std::size_t draw) const;
  /// f_max / S at a node, S: the radiance that the part has by itself.
  double reflection(const Part& part, std::size_t node, const RenderTables& tables) const;
  double nearest2_m2(std::size_t entity, std::size_t light, const WorldState& state) const;
  double share(double part) const { return part / static_cast<double>(simulation_.lights.size()); }
  double strength_m2(std::size_t entity, std::size_t light, const WorldState& state, bool sunlit = false) const {
    const std::size_t at = entity * simulation_.lights.size() + light;
    return state.lightLevels[light] > 0.0 ? state.lightLevels[light] * (sunlit ? inSunshine_ : ratio_)[at] : 0.0;
  }
  std::vector<double> sunshineOf(const Plan& plan) const;
  /// Of a part at each node: f_max, and the radiance that it has by itself; f_max I / S of a channel, or of a node without an accuracy.
  double ratioOf(const std::vector<double>& most, const std::vector<double>& self, std::size_t light, std::size_t at) const;
  /// The same beside what the part reflects of sunshine, whatever its textures say: of each component lamp and sun take the same share.
  double inSunshineOf(const Part& part, std::size_t light, std::size_t slot) const;
  const Simulation& simulation_;
  std::vector<SpectralNode> nodes_;
  double accuracy_;
  std::vector<std::vector<double>> weight_;  ///< [slot][node]
  std::vector<double> floor_;                ///< [slot]
  std::vector<double> sunshine_;             ///< irradiance at the ground that counts as full sunshine, per node; empty: there is none
  std::vector<Part> parts_;
  std::vector<double> intensity_;   ///< [light][node], level 1
  std::vector<double> ratio_;       ///< [entity][light]: greatest f_max I / S over channels (nodes) and surfaces at level 1 [m2]; 0: reflects none of it
  std::vector<double> inSunshine_;  ///< the same
};

}  // namespace pitviper
