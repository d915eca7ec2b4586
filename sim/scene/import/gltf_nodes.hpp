#pragma once
// The nodes of a glTF file, in double precision: its reader has single.
#include <glm/glm.hpp>
#include <vector>

#include "sim/scene/import/json.hpp"

namespace pitviper {

/// Takes the nodes' tree and transforms out of a checked glTF and returns, for each node, what is left to do to the vertices that the reader gives for it:
/// its global transform (glTF 2.0, 3.5). Joints of skins keep theirs, from the first joint of all.
std::vector<glm::dmat4> takePlacements(Json& root);

}  // namespace pitviper
