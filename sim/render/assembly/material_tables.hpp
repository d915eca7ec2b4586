#pragma once
// What the programs know of materials: columns by angles and nodes, directional-hemispherical reflectances and emissivities by view angle, responses to
// light from all around.
#include "sim/render/assembly/tables.hpp"

namespace pitviper {

/// Appends a value for each of a material's components, three to a vec4, and what the first vec4's last place holds.
template <class ValueOf>
void appendComponents(std::vector<float>& into, const SurfaceTables& t, const Material& m, double last, const ValueOf& valueOf) {
  for (size_t v = 0; v < static_cast<size_t>(t.vectors); ++v) {
    for (size_t k = 3 * v; k < 3 * v + 3; ++k) into.push_back(k < m.reflections.size() ? static_cast<float>(valueOf(k)) : 0.0f);
    into.push_back(v == 0 ? static_cast<float>(last) : 0.0f);
  }
}

/// `lobes`: all of its kind's programs, in the order of their numbers. `around`: null without ambient light by direction.
void appendMaterial(SurfaceTables& tables, const Simulation& simulation, const Material& material, const std::set<std::pair<std::string, std::string>>& lobes,
                    const Plan& plan, const NodeSurroundings* around);

}  // namespace pitviper
