#include "sim/scene/scene.hpp"

namespace pitviper {

double PointLight::levelAt(double t) const {
  if (level.empty()) return 1.0;
  if (t < level.front().first || t > level.back().first) return 0.0;
  for (size_t i = 0; i + 1 < level.size(); ++i) {
    const auto &a = level[i], &b = level[i + 1];
    if (t <= b.first) return a.second + (t - a.first) / (b.first - a.first) * (b.second - a.second);
  }
  return level.back().second;
}

Pose composed(const Pose& parent, const Pose& child) {
  return {parent.position + parent.orientation * child.position, glm::normalize(parent.orientation * child.orientation)};
}

WorldState advance(const std::vector<Entity>& entities, const std::vector<PointLight>& lights, double time_s) {
  WorldState state;
  state.time_s = time_s;
  for (const auto& e : entities) {
    const Pose own = e.motion.at(time_s);  // a parent comes before its children
    state.entities.push_back(e.parent >= 0 ? composed(state.entities[static_cast<size_t>(e.parent)], own) : own);
  }
  for (const auto& l : lights) {
    const Pose own = l.motion.at(time_s);
    state.lights.push_back(l.parent >= 0 ? composed(state.entities[static_cast<size_t>(l.parent)], own).position : own.position);
    state.lightLevels.push_back(l.levelAt(time_s));
  }
  return state;
}

}  // namespace pitviper
