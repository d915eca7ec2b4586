#include "scenarios/reader/move_files.hpp"

namespace pitviper {

void moveFiles(Value& value, const std::filesystem::path& folder) {
  for (Value& item : value.items) moveFiles(item, folder);
  for (auto& [key, item] : value.entries) {
    moveFiles(item, folder);
    const bool names = key == "file" || key == "table" || key == "tape7" || key == "csv";
    if (names && item.kind == Value::Kind::Scalar && std::filesystem::path(item.text).is_relative()) item.text = (folder / item.text).string();
  }
}

}  // namespace pitviper
