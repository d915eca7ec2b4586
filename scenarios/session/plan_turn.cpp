#include "scenarios/session/plan_turn.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "sim/plan/plan_cache.hpp"
#include "sim/plan/planner.hpp"
#include "sim/scene/cache_folder.hpp"

namespace pitviper {
namespace {

/// How often it looks whether it is its turn.
constexpr std::chrono::milliseconds kLookAgain{20};
/// Files that are locked: by the first digits of a plan's key. Two plans of one file wait for each other, which costs time alone.
constexpr std::size_t kDigits = 2;

}  // namespace

PlanTurn::PlanTurn(const Simulation& sim, const Camera& drawn, const std::function<void()>& waiting) {
  const std::filesystem::path folder = cacheFolder();
  if (folder.empty() || !(drawn.spectral.accuracy > 0.0) || isPlanKnown(sim, drawn)) return;
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  const std::filesystem::path file = folder / ("turn-" + digitsOf(planKey(sim, {&drawn, nullptr})).substr(0, kDigits) + ".lock");
  file_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  while (file_ >= 0 && ::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    waiting();
    std::this_thread::sleep_for(kLookAgain);
  }
}

PlanTurn::~PlanTurn() {
  if (file_ >= 0) ::close(file_);  // which lets it go
}

}  // namespace pitviper
