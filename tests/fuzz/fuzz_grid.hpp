#pragma once
// Feeds damaged files of grids to importGrid().
#include <cstdint>
#include <filesystem>
#include <vector>

namespace pitviper {

/// The sound files that are damaged: 4x3x5 nodes as .vti (in words, of cells, in base64, appended raw), and, where there is a reader of it, `vdb`; each with
/// arrays 'T' and 'CO2'. Returns their paths.
std::vector<std::filesystem::path> writeSoundGrids(const std::filesystem::path& folder, const std::filesystem::path& vdb);

struct GridFuzzReport {
  int read = 0, refused = 0;
  int failed = 0;  ///< ended in anything else than a grid of finite numbers or a UserError of one line; their seeds are printed, their files stay
};

/// Writes `iterations` damaged copies of the sound files below corpus_folder and imports them. Same seed, same files.
GridFuzzReport fuzzGrids(std::uint64_t seed, int iterations, const std::vector<std::filesystem::path>& sound, const std::filesystem::path& corpus_folder);

}  // namespace pitviper
