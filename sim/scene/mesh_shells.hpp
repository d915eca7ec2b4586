#pragma once
// The connected pieces of a mesh's surface.
#include <cstdint>
#include <vector>

#include "sim/scene/mesh.hpp"

namespace pitviper {

struct MeshShell {
  enum class Kind {
    Open,    ///< a sheet with a border
    Closed,  ///< encloses a volume
    Unclear  ///< without a border, and yet without an inside: one-sided, without volume, or tangled beyond telling
  };
  Kind kind = Kind::Open;
  std::vector<std::uint32_t> triangles;
  double volume_m3 = 0.0;      ///< of a closed one, positive
  double fileVolume_m3 = 0.0;  ///< the same by the winding that it came with
};

/// Shells of the triangles of positive area; vertices at one place are one. `turn`, per triangle, says which must be turned round for the triangles of
/// each shell to go round alike: of a closed one counter-clockwise seen from outside, of an open one as most of its area is, of an unclear one as it came.
/// Where more than two triangles share an edge (bodies that touch) those of one part belong together, then those that hang together elsewhere; what
/// is left is told apart by what lies before and behind it.
std::vector<MeshShell> shellsOf(const Mesh& mesh, std::vector<char>& turn);

}  // namespace pitviper
