#include "sim/gl/driver_cache.hpp"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>

namespace pitviper {
namespace {

/// Of disk_cache_os.c of Mesa, all releases with one file an entry: 2^16 keys of 20 bytes behind a size of 8.
constexpr off_t kIndexBytes = (1 << 16) * 20 + 8;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

bool isOn(const std::string& value) { return value == "1" || value == "true" || value == "yes" || value == "y"; }

/// As Mesa looks for it; empty: it does without by itself.
std::filesystem::path mesaFolder() {
  for (const char* name : {"MESA_SHADER_CACHE_DISABLE", "MESA_GLSL_CACHE_DISABLE"})
    if (isOn(variable(name))) return {};
  for (const char* name : {"MESA_SHADER_CACHE_DIR", "MESA_GLSL_CACHE_DIR", "XDG_CACHE_HOME"})
    if (const std::string folder = variable(name); !folder.empty()) return std::filesystem::path(folder) / "mesa_shader_cache";
  const passwd* user = getpwuid(getuid());  // it does not look at HOME
  return user && user->pw_dir ? std::filesystem::path(user->pw_dir) / ".cache" / "mesa_shader_cache" : std::filesystem::path();
}

bool isFull(int reason) { return reason == ENOSPC || reason == EDQUOT || reason == EFBIG; }

/// 0, or why there is no room.
int takeRoom(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return isFull(failed.value()) ? failed.value() : 0;  // what may not be written Mesa does without
  const std::filesystem::path index = folder / "index";
  const int file = open(index.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (file < 0) return isFull(errno) ? errno : 0;
  struct stat before {};
  const bool isFile = fstat(file, &before) == 0 && S_ISREG(before.st_mode);
  const int reason = isFile ? posix_fallocate(file, 0, kIndexBytes) : 0;
  close(file);
  if (isFile && isFull(reason) && before.st_size == 0) std::filesystem::remove(index, failed);
  return isFull(reason) ? reason : 0;
}

std::atomic<TellOfDriver> gTell{nullptr};

}  // namespace

std::string takeRoomForDriverCache() {
  const std::filesystem::path folder = mesaFolder();
  const int reason = folder.empty() ? 0 : takeRoom(folder);
  if (reason == 0) return {};
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
  setenv("MESA_GLSL_CACHE_DISABLE", "true", 1);  // of Mesa before 21.3
  setenv("__GL_SHADER_DISK_CACHE", "0", 1);      // NVIDIA's
  return "note: " + folder.parent_path().string() + " has no room for the driver's cache of shaders (" + std::strerror(reason) +
         "), so it goes without, and compiles them anew in each run; free 2 MB there, or set XDG_CACHE_HOME to a folder with room";
}

bool driverKeepsPrograms() { return !mesaFolder().empty(); }

void tellOfDriverBy(TellOfDriver tell) { gTell = tell; }

void prepareDriverCache() {
  static std::once_flag once;
  std::call_once(once, [] {
    const std::string line = takeRoomForDriverCache();
    if (const TellOfDriver tell = gTell; tell && !line.empty()) tell(line.c_str());
  });
}

}  // namespace pitviper
