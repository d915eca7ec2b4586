#include "scenarios/commands/own_cache.hpp"

#include <cerrno>
#include <cstdlib>

#include "sim/image/atomic_file.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

constexpr const char *kNow = "now", *kMarked = "marked";

void copyAll(const fs::path& from, const fs::path& to) {
  fs::remove_all(to);
  fs::copy(from, to, fs::copy_options::recursive);
}

}  // namespace

OwnCache::OwnCache() {
  std::string name = (fs::temp_directory_path() / "pitviper_cache_XXXXXX").string();
  if (!::mkdtemp(name.data())) throw OutputError(name, "cannot make a folder for what is kept between runs", errno);
  folder_ = name;
  clear();
}

OwnCache::~OwnCache() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::map<std::string, std::string> OwnCache::environment() const {
  const std::string now = (folder_ / kNow).string();
  return {{"XDG_CACHE_HOME", now}, {"MESA_SHADER_CACHE_DIR", now}, {"MESA_GLSL_CACHE_DIR", now}, {"__GL_SHADER_DISK_CACHE_PATH", now}};
}

std::size_t OwnCache::driverFiles() const {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / kNow))
    if (entry.is_regular_file() && entry.path().filename() != "index" && entry.path().parent_path().filename() != "pitviper") ++count;
  return count;
}

void OwnCache::clear() {
  fs::remove_all(folder_ / kNow);
  fs::create_directories(folder_ / kNow);
}

void OwnCache::mark() { copyAll(folder_ / kNow, folder_ / kMarked); }
void OwnCache::back() { copyAll(folder_ / kMarked, folder_ / kNow); }

}  // namespace pitviper
