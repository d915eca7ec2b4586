// Damaged grids of flows, .vti and .vdb: each must be read, or refused in one line that names the file, without crash or hang, whatever the libraries that read
// them do. PITVIPER_FUZZ_GRIDS sets their number (default 100), PITVIPER_FUZZ_SEED the first seed.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "sim/parameters/module_on_demand.hpp"
#include "sim/scene/grid_import.hpp"
#include "tests/fuzz/fuzz_grid.hpp"

namespace pitviper {
namespace {

std::uint64_t fromEnvironment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : static_cast<std::uint64_t>(std::atoll(text));
}

class FuzzGrids : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path build = PITVIPER_BUILD_DIR, source = PITVIPER_SOURCE_DIR;
    if (!std::filesystem::exists(build / "libpitviper_mesh_import.so")) GTEST_SKIP() << "built without VTK";
    setModuleFolder(build);
    const bool vdb = std::filesystem::exists(build / "libpitviper_vdb_import.so");
    sound_ = writeSoundGrids(folder_ / "sound", vdb ? source / "tests/support/gaussian.vdb" : std::filesystem::path());
  }
  void TearDown() override {
    setModuleFolder({});
    if (!HasFailure()) std::filesystem::remove_all(folder_);
  }
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() / ("pitviper_fuzz_grids_" + std::to_string(getpid()));
  std::vector<std::filesystem::path> sound_;
};

// Otherwise every case would be refused for a reason of the test's own.
TEST_F(FuzzGrids, UndamagedOnesAreRead) {
  for (const auto& file : sound_) {
    EXPECT_NO_THROW(importGrid(file, {"T", "CO2"}, {})) << file;
  }
}

TEST_F(FuzzGrids, DamagedOnesAreReadOrRefused) {
  const auto seed = fromEnvironment("PITVIPER_FUZZ_SEED", 1);
  const auto count = static_cast<int>(fromEnvironment("PITVIPER_FUZZ_GRIDS", 100));
  const GridFuzzReport report = fuzzGrids(seed, count, sound_, folder_);
  std::printf("%d damaged grids from seed %llu: %d read, %d refused, %d failed\n", count, static_cast<unsigned long long>(seed), report.read, report.refused,
              report.failed);
  EXPECT_EQ(report.failed, 0) << "seeds above, inputs in " << folder_;
  EXPECT_GT(report.refused, count / 8) << "the damage does not damage";
}

}  // namespace
}  // namespace pitviper
