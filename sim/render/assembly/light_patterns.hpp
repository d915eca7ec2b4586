#pragma once
// How lights send by direction, on the GPU: the bodies of their patterns, and what a light's entry in a body's row holds besides for them.
#include <set>
#include <utility>
#include <vector>

#include "sim/gl/shader_assembler.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

class LightPatterns {
 public:
  explicit LightPatterns(const Simulation& simulation);
  /// Of one light in a row (sim/render/assembly/glsl/light_list.glsl): two more where any light has a pattern.
  int texels() const { return kinds_.empty() ? 3 : 5; }
  void addSlots(ShaderSlots& slots) const;
  /// Puts a light's own into its entry, of the row of a body that is turned so. `entry`: texels() of them.
  void put(std::size_t light, const WorldState& state, const glm::dquat& body, glm::vec4* entry) const;

 private:
  const Simulation& simulation_;
  std::set<std::pair<std::string, std::string>> kinds_;  ///< file and function; numbered from 1 on
};

}  // namespace pitviper
