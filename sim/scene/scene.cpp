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

}  // namespace pitviper
