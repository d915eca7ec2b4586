#include "sim/scene/scene.hpp"

namespace pitviper {

Pose composed(const Pose& parent, const Pose& child) {
  return {parent.position + parent.orientation * child.position, glm::normalize(parent.orientation * child.orientation)};
}

}  // namespace pitviper
