#pragma once
// What a field's program reads of its gases: spectra at a plan's nodes, four nodes to a texel.
#include <glm/glm.hpp>
#include <vector>

#include "sim/plan/plan.hpp"

namespace pitviper {

/// Of drops, per four nodes.
constexpr std::size_t kCloudRows = 10;

/// Texels: of each mixture one (first texel of its levels, their number, first texel of what else it has); of each mixture 4 `levelFours` temperatures [K]; the
/// levels' absorption per amount, rows of `fours`; of each mixture and four nodes five (thermal share, own radiance, ambient light scattered, sunlight
/// scattered for a phase function of 1, asymmetry), where any has more than absorption; of a field with drops, for each four nodes, `kCloudRows`;
/// `kBlackEntries` rows of Planck radiance, evenly over 1 / T. A mixture: gases that a field's shader adds up as one, by FieldState::share. Of drops: albedo,
/// asymmetry, irradiance of the sun, radiance of sky and ground, four weights and a coordinate (physics::CloudOptics).
class FieldTables {
 public:
  FieldTables(const Simulation& simulation, const Plan& plan, const FieldBody& field);
  /// True where the texels changed with the shares of the gases.
  bool mix(const std::array<double, kMostGases>& share);

  std::vector<glm::vec4> texels;
  std::vector<glm::vec4> temperatures;  ///< of each mixture `levelFours`, ended by some far above any
  int mixtures = 0, levelFours = 1, fours = 0, blackAt = 0, blackEntries = 0;
  bool scatters = false;  ///< some gas has more than absorption
  bool drops = false;     ///< it has drops: the first texel's w says where their rows begin
  float firstInverse_K = 0.0f, entriesPerInverse = 1.0f;

 private:
  struct Mixture {
    std::vector<size_t> gases;
    std::vector<double> temperature_K;                   ///< all that one of them has
    std::vector<std::vector<std::vector<double>>> rows;  ///< of each gas at each: absorption at the nodes
    size_t at = 0;                                       ///< first texel of its rows
  };
  std::vector<Mixture> mixed_;
  std::array<double, kMostGases> share_{};
};

}  // namespace pitviper
