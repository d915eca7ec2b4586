#pragma once
// What a field's program reads of its gases: spectra at a plan's nodes, four nodes to a texel.
#include <glm/glm.hpp>
#include <vector>

#include "sim/plan/plan.hpp"

namespace pitviper {

/// Texels: of each gas one (first texel of its levels, their number, first texel of what else it has); of each gas `levels` temperatures [K]; the levels'
/// absorption per amount, rows of `fours`; of each gas and four nodes five (thermal share, own radiance, ambient light scattered, sunlight scattered for a
/// phase function of 1, asymmetry), where any gas has more than absorption; `kBlackEntries` rows of Planck radiance, evenly over 1 / T.
struct FieldTables {
  std::vector<glm::vec4> texels;
  int gases = 0, levels = 1, fours = 0, blackAt = 0;
  bool scatters = false;     ///< some gas has more than absorption
  float firstInverse_K = 0.0f, entriesPerInverse = 1.0f;
};
constexpr int kBlackEntries = 384;
FieldTables makeFieldTables(const Simulation& simulation, const Plan& plan, const FieldBody& field);

/// Lines across a pixel each way, at most.
int fieldLinesAcross(double accuracy);

}  // namespace pitviper
