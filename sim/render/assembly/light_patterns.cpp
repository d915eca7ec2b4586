#include "sim/render/assembly/light_patterns.hpp"

namespace pitviper {

LightPatterns::LightPatterns(const Simulation& simulation) : simulation_(simulation) {
  for (const PointLight& l : simulation.lights)
    if (l.pattern.body) kinds_.emplace(l.pattern.file, l.pattern.function);
}

void LightPatterns::addSlots(ShaderSlots& slots) const {
  slots.generated["light_texels"] = "const int kLightTexels = " + std::to_string(texels()) + ";\n";
  slots.generated["light_patterns"] = slots.generated["light_pattern"] = "";
  if (kinds_.empty()) return;
  std::string uses, choice;
  int number = 0;
  for (const auto& [file, function] : kinds_) {
    uses += "//@use " + file + "\n";
    choice += "  if (kind == " + std::to_string(++number) + ") return " + function + "(parameters, direction);\n";
  }
  slots.generated["light_patterns"] = "//@use sim/render/assembly/glsl/light_patterns.glsl\n";
  slots.generated["light_bodies"] = uses;
  slots.generated["light_kinds"] = choice;
  slots.generated["light_pattern"] = "  if (!sun && here.factor > 0.0) here.factor *= lightPattern(entry, -here.to);\n";
}

void LightPatterns::put(std::size_t light, const WorldState& state, const glm::dquat& body, glm::vec4* entry) const {
  const LightPattern& pattern = simulation_.lights[light].pattern;
  if (!pattern.body) return;
  entry[2].z = static_cast<float>(1 + std::distance(kinds_.begin(), kinds_.find({pattern.file, pattern.function})));
  const glm::dquat turn = glm::inverse(state.lightPoses[light].orientation) * body;
  entry[3] = glm::vec4(turn.x, turn.y, turn.z, turn.w);
  entry[4] = glm::vec4(pattern.parameters);
}

}  // namespace pitviper
