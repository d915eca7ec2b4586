#include "sim/scene/scene.hpp"

namespace pitviper {

Pose WorldState::bodyPose(std::size_t entity) const {
  const Pose& mesh = entities[entity];
  return entity < offsets_m.size() ? Pose{mesh.position - mesh.orientation * offsets_m[entity], mesh.orientation} : mesh;
}

Pose composed(const Pose& parent, const Pose& child) {
  return {parent.position + parent.orientation * child.position, glm::normalize(parent.orientation * child.orientation)};
}

}  // namespace pitviper
