#pragma once
// What MODTRAN writes its runs into: tape7 (4, 5, 6), JSON (6), comma-separated values (6), known by their content.
#include <filesystem>
#include <vector>

#include "atmosphere/tape7.hpp"

namespace pitviper {

/// All runs of a file. Errors: UserError with line and column.
std::vector<Tape7Run> readModtran(const std::filesystem::path& path);
/// The same of a text; `name` is the file in messages.
std::vector<Tape7Run> parseModtran(std::string_view text, const std::string& name);

}  // namespace pitviper
