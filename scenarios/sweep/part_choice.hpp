#pragma once
// A sweep in parts that are drawn apart, each with a file of its own: which samples a part has, and which parts' files lie in a folder.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// So many parts at most.
inline constexpr int kMostParts = 1000000;

/// One of `of` parts: the samples whose number leaves `part` when divided by `of`, so that parts have alike many and each has some of every region.
struct PartChoice {
  int part = 0;  ///< from 0
  int of = 1;

  bool has(int sample) const { return sample % of == part; }
  /// "3/40", as --part has it.
  std::string text() const { return std::to_string(part) + "/" + std::to_string(of); }
};

/// Of "3/40". Errors: UserError.
PartChoice readPartChoice(const std::string& text, const Location& where);

/// FOLDER/parts/part_3_of_40.sqlite
std::filesystem::path partFile(const std::filesystem::path& folder, const PartChoice& choice);

/// Files of parts, all of one division.
struct PartFiles {
  int of = 0;  ///< parts of the division; 0: no file is there
  std::map<int, std::filesystem::path> files;
};

/// What lies in FOLDER/parts under names of parts; other names are passed over. Errors: UserError where parts of several divisions lie there, or one that is no
/// file.
PartFiles partFilesIn(const std::filesystem::path& folder);

/// As partFilesIn, where the sweep is in `parts`. Errors: UserError, also where parts of another division lie there.
PartFiles partFilesIn(const std::filesystem::path& folder, int parts);

}  // namespace pitviper
