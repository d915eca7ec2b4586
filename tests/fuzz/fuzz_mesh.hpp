#pragma once
// Feeds damaged mesh files to importMesh().
#include <cstdint>
#include <filesystem>
#include <vector>

namespace pitviper {

/// Writes `iterations` damaged files below corpus_folder (created; the cache is put there too), each a mutation of a
/// small sound one, and imports them. Returns how many ended in anything else than a valid mesh or a UserError; prints
/// their seeds and leaves their files. Damages a serialized mesh as often, which must be refused. Same seed, same
/// files.
int fuzzMeshes(std::uint64_t seed, int iterations, const std::filesystem::path& corpus_folder);

/// The sound files that are damaged: a tetrahedron or a quad as .obj .stl (ascii and binary) .ply (ascii and binary)
/// .vtp .gltf .glb. Returns their paths.
std::vector<std::filesystem::path> writeSoundMeshes(const std::filesystem::path& folder);

}  // namespace pitviper
