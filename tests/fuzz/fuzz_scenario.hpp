#pragma once
// Feeds damaged scenarios and library files to the scenario reader, in this process.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pitviper {

struct FuzzReport {
  int accepted = 0;        ///< still a scenario
  int refused = 0;         ///< a UserError of one line with place and fix
  int failed = 0;          ///< anything else: another exception, a message without place or fix, too much memory
  double slowest_s = 0.0;  ///< of the processor
  std::uint64_t slowestSeed = 0;
  long peakMemory_kB = 0;
};

/// All scenarios and library files that are shipped below the repository's root.
std::vector<std::filesystem::path> shippedFiles(const std::filesystem::path& root);

/// Reads `iterations` damaged copies of `files` (case i from seed + i: same seed, same cases). Library files are read through a
/// small scenario that uses them; terrains are made coarse first. `folder` is created and holds the case being read, so that
/// a crash leaves its input there; inputs that failed are kept as failed_<seed>.yaml and told on stderr. A case of
/// more than 60 s of the processor ends the program (SIGABRT).
FuzzReport fuzzScenarios(std::uint64_t seed, int iterations, const std::vector<std::filesystem::path>& files, const std::filesystem::path& root,
                         const std::filesystem::path& folder);

/// Reads all of `files` undamaged in the same way.
FuzzReport readShipped(const std::vector<std::filesystem::path>& files, const std::filesystem::path& root, const std::filesystem::path& folder);

}  // namespace pitviper
