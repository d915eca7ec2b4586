#pragma once
// Files that a tree names, found from where it is put.
#include <filesystem>
#include <functional>

#include "sim/parameters/value.hpp"

namespace pitviper {

/// Relative names of files under keys such as `file`, `table`, `tape7` or `csv`, which are found from `folder`, are found from there as well where the tree is
/// put elsewhere.
void moveFiles(Value& value, const std::filesystem::path& folder);

/// The same for a scenario whose values were written in several files: each name is found from the folder of the file in which it was written, null for those
/// that are found from `base` already. What `sinks` write is not moved.
void moveFiles(Value& scenario, const std::function<const std::filesystem::path*(const std::string& file)>& folderOf, const std::filesystem::path& base);

}  // namespace pitviper
