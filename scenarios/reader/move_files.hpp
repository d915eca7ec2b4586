#pragma once
// Files that a tree names, found from where it is put.
#include <filesystem>

#include "sim/parameters/value.hpp"

namespace pitviper {

/// Relative names of files under the keys `file`, `table`, `tape7` and `csv`, which are found from `folder`, are found from there as well where the tree is
/// put elsewhere.
void moveFiles(Value& value, const std::filesystem::path& folder);

}  // namespace pitviper
