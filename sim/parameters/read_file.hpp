#pragma once
// A whole file in memory: the one way in which a file that a user names is read.
#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// What is wanted of a file, for its bound and for messages.
struct FileWanted {
  std::string what = "a readable file";                    ///< "a CSV file with a spectrum"
  std::uintmax_t mostBytes = std::uintmax_t{4} << 30;      ///< a picture of 32768 x 32768 floats has as many
  std::string fix = "check the path and its permissions";  ///< for one that is missing
  std::string fixLarge = "use a smaller file";             ///< for one beyond mostBytes
};

/// Reads a regular file once: never a device, a pipe, a socket or a folder (links are followed), never more than its size when opened, and never waits.
/// `askedAt`: where its name was written; without, messages begin with the file itself.
/// Errors: UserError if it is missing, not a regular file, unreadable, larger than `mostBytes` or than the memory.
std::string readWholeFile(const std::filesystem::path& path, const FileWanted& wanted = {}, const Location& askedAt = {});

/// The same for the first `bytes` of it, or all where it has fewer; `wanted.mostBytes` has no say.
std::string readFileStart(const std::filesystem::path& path, std::size_t bytes, const FileWanted& wanted = {}, const Location& askedAt = {});

}  // namespace pitviper
