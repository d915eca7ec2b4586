#include "scenarios/reader/move_files.hpp"

#include <algorithm>
#include <iterator>

namespace pitviper {
namespace {

namespace fs = std::filesystem;

bool namesFile(const std::string& key, const Value& item) {
  static constexpr const char* keys[] = {"file", "table", "tape7", "csv", "columns_file", "radiance_file", "sounding"};
  return std::find(std::begin(keys), std::end(keys), key) != std::end(keys) && item.kind == Value::Kind::Scalar && fs::path(item.text).is_relative();
}

/// From one folder to another, or the other as it is where no way is known.
fs::path wayTo(const fs::path& folder, const fs::path& base) {
  if (base.empty() || base == ".") return folder;
  const fs::path way = folder.empty() ? fs::path(".").lexically_relative(base) : folder.lexically_relative(base);
  if (!way.empty()) return way;
  std::error_code failed;
  const fs::path whole = fs::absolute(folder, failed);
  return failed ? folder : whole;
}

}  // namespace

void moveFiles(Value& value, const fs::path& folder) {
  for (Value& item : value.items) moveFiles(item, folder);
  for (auto& [key, item] : value.entries) {
    moveFiles(item, folder);
    if (namesFile(key, item)) item.text = (folder / item.text).string();
  }
}

namespace {
void moveAll(Value& value, const std::function<const fs::path*(const std::string&)>& folderOf, const fs::path& base) {
  for (Value& item : value.items) moveAll(item, folderOf, base);
  for (auto& [key, item] : value.entries) {
    moveAll(item, folderOf, base);
    if (!namesFile(key, item)) continue;
    const fs::path* folder = folderOf(item.where.file);
    if (folder && *folder != base) item.text = (wayTo(*folder, base) / item.text).string();
  }
}
}  // namespace

void moveFiles(Value& scenario, const std::function<const fs::path*(const std::string&)>& folderOf, const fs::path& base) {
  for (Value& item : scenario.items) moveAll(item, folderOf, base);
  for (auto& [key, item] : scenario.entries)
    if (key != "sinks") moveAll(item, folderOf, base);
}

}  // namespace pitviper
