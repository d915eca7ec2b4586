#pragma once
// Checks of whole files before a VTK reader sees them. The readers trust what they read (fixed buffers, unchecked
// counts and indices), so the simple formats are parsed here in full and VTK gets a canonical copy that holds only what
// was checked. All throw ImportFailure with line and column, or byte.
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim/scene/import/import_reply.hpp"
#include "sim/scene/import/memory_file.hpp"

namespace pitviper {

struct CheckedFile {
  std::string bytes;                      ///< canonical copy for the reader; empty: the file's own are fit
  std::vector<std::uint32_t> partOfFace;  ///< per face in file order, index into partNames; empty: one part
  std::vector<std::string> partNames;     ///< of glTF: the names of all nodes
  /// Per face in file order, where it stands: a line, or a byte of a binary file. Empty: not known.
  std::vector<std::uint64_t> placeOfFace;
  bool placesAreBytes = false;
  glm::dvec3 origin{0.0};                 ///< what was taken off the canonical copy's vertices
  std::vector<glm::dmat4> placements;     ///< of glTF: per node, what is left to do to its vertices
  /// What a glTF's buffers hold, under the names that the canonical copy calls them by.
  std::vector<std::unique_ptr<const MemoryFile>> buffers;
};

/// Largest number of corners of one face: beyond any modeller's, and short enough for the readers' line buffers.
inline constexpr long long kMostCorners = 1024;

CheckedFile checkObj(const std::string& file, std::string_view text);
CheckedFile checkStl(const std::string& file, std::string_view bytes);
CheckedFile checkPly(const std::string& file, std::string_view bytes);
CheckedFile checkVtp(const std::string& file, std::string_view bytes);
void checkVti(const std::string& file, std::string_view bytes);
/// .gltf and .glb. The canonical copy has no images, textures and materials, so that nothing but the buffers is read, and no transforms (gltf_nodes.hpp).
CheckedFile checkGltf(const ImportRequest& request);

}  // namespace pitviper
