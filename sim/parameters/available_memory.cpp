#include "sim/parameters/available_memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace pitviper {
namespace {

/// A number of a file of one; nothing for "max" and where there is no such file.
std::optional<double> numberIn(const std::filesystem::path& file) {
  std::ifstream in(file);
  double number = 0.0;
  if (in >> number) return number;
  return std::nullopt;
}

/// The value behind a word in a file of lines "word value".
std::optional<double> numberBehind(const std::filesystem::path& file, const std::string& word) {
  std::ifstream in(file);
  std::string first;
  double number = 0.0;
  while (in >> first) {
    if (first == word && in >> number) return number;
    in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return std::nullopt;
}

/// Least room that the control groups leave this process, whose path is that of the second version's line in /proc/self/cgroup, and those above it.
std::optional<double> roomOfGroups() {
  std::optional<double> least;
  const auto take = [&](const std::filesystem::path& folder, const char* most, const char* used, const char* cache) {
    const auto limit = numberIn(folder / most), now = numberIn(folder / used);
    if (!limit || !now) return;
    const double room = *limit - *now + numberBehind(folder / "memory.stat", cache).value_or(0.0);
    least = std::min(room, least.value_or(room));
  };
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':'), second = first == line.npos ? line.npos : line.find(':', first + 1);
    if (second == line.npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    std::filesystem::path path = std::filesystem::path(line.substr(second + 1)).relative_path();
    for (int up = 0; up < 64; ++up, path = path.parent_path()) {  // a bound: groups are a few deep
      if (controllers.empty()) take("/sys/fs/cgroup" / path, "memory.max", "memory.current", "inactive_file");
      else if (controllers.find("memory") != controllers.npos)
        take("/sys/fs/cgroup/memory" / path, "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file");
      if (path.empty()) break;
    }
  }
  return least;
}

}  // namespace

std::optional<double> availableMemory_bytes() {
  std::optional<double> least;
  const auto take = [&](std::optional<double> room) {
    if (room) least = std::min(*room, least.value_or(*room));
  };
  if (const auto kilobytes = numberBehind("/proc/meminfo", "MemAvailable:")) take(1024.0 * *kilobytes);
  take(roomOfGroups());
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    if (const auto pages = numberIn("/proc/self/statm")) take(static_cast<double>(limit.rlim_cur) - *pages * static_cast<double>(sysconf(_SC_PAGESIZE)));
  return least;
}

}  // namespace pitviper
