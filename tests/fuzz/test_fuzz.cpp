// Damaged scenarios, library files and meshes: each must be read or refused in one line, without crash, hang or more than 1 GB.
// PITVIPER_FUZZ sets the number of scenarios (default 600, with PITVIPER_LONG=1 1500; the full test is 100000), PITVIPER_FUZZ_MESHES of meshes (default a
// fifteenth of that, at least 100), PITVIPER_FUZZ_SEED the first seed.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "sim/parameters/module_on_demand.hpp"
#include "sim/scene/mesh_import.hpp"
#include "tests/fuzz/fuzz_mesh.hpp"
#include "tests/fuzz/fuzz_scenario.hpp"
#include "tests/support/long_tests.hpp"

namespace pitviper {
namespace {

long long fromEnvironment(const char* name, long long otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoll(text);
}

const int kScenarios = static_cast<int>(fromEnvironment("PITVIPER_FUZZ", test::runsLong() ? 1500 : 600));
const int kMeshes = static_cast<int>(fromEnvironment("PITVIPER_FUZZ_MESHES", std::max(kScenarios / 15, 100)));
const auto kSeed = static_cast<std::uint64_t>(fromEnvironment("PITVIPER_FUZZ_SEED", 1));

/// Kept where something failed, with the inputs that did it.
class Fuzz : public testing::Test {
 protected:
  void TearDown() override {
    if (!HasFailure()) std::filesystem::remove_all(folder_);
  }
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() / ("pitviper_fuzz_" + std::to_string(getpid()));
};

TEST_F(Fuzz, DamagedScenariosAreReadOrRefused) {
  const auto files = shippedFiles(PITVIPER_SOURCE_DIR);
  ASSERT_GT(files.size(), 20u);
  const FuzzReport report = fuzzScenarios(kSeed, kScenarios, files, PITVIPER_SOURCE_DIR, folder_);
  std::printf("%d damaged scenarios and library files from seed %llu: %d accepted, %d refused, %d failed; slowest %.2f s (seed %llu), peak memory %ld MB\n",
              kScenarios, static_cast<unsigned long long>(kSeed), report.accepted, report.refused, report.failed, report.slowest_s,
              static_cast<unsigned long long>(report.slowestSeed), report.peakMemory_kB / 1024);
  EXPECT_EQ(report.failed, 0) << "seeds above, inputs in " << folder_;
  EXPECT_GT(report.refused, kScenarios / 4) << "the damage does not damage";
}

TEST_F(Fuzz, UndamagedFilesAreAccepted) {
  // The same way of reading with nothing damaged: otherwise every case would be refused for a reason of the test's own.
  const FuzzReport report = readShipped(shippedFiles(PITVIPER_SOURCE_DIR), PITVIPER_SOURCE_DIR, folder_);
  EXPECT_EQ(report.refused, 0);
  EXPECT_EQ(report.failed, 0);
}

TEST_F(Fuzz, DamagedMeshesAreImportedOrRefused) {
  setModuleFolder(PITVIPER_BUILD_DIR);
  std::filesystem::create_directories(folder_);
  const int failures = fuzzMeshes(kSeed, kMeshes, folder_);
  std::printf("%d damaged meshes from seed %llu: %d failed\n", kMeshes, static_cast<unsigned long long>(kSeed), failures);
  EXPECT_EQ(failures, 0) << "seeds above, inputs in " << folder_;
}

}  // namespace
}  // namespace pitviper
