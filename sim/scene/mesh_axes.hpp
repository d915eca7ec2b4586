#pragma once
// Which way a mesh stands in its file.
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "sim/scene/mesh.hpp"

namespace pitviper {

/// Where a body's nose and its upper side point, in the axes of its file.
struct FileAxes {
  glm::ivec3 forward{1, 0, 0}, up{0, 0, 1};
};

/// As importMesh() takes a file: glTF's front is +z and its up +y, by its standard; all others, which say nothing of it, stand as bodies do here.
FileAxes usualAxes(const std::string& file);

/// "+x", "-z"; nothing for other words.
std::optional<glm::ivec3> axisNamed(const std::string& word);

/// Turns a mesh that was read with one pair of axes into what it is with another; forward and up are at right angles in each. Exact.
void turnAxes(Mesh& mesh, const FileAxes& readAs, const FileAxes& meant);

}  // namespace pitviper
