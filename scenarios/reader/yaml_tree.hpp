#pragma once
// YAML text to a tree that knows its places. The only user of yaml-cpp.
#include <filesystem>
#include <string>
#include <vector>

#include "sim/parameters/value.hpp"

namespace pitviper {

/// Limits on hostile input: larger files, deeper nesting and more nodes (aliases expanded) are refused. The parser holds a whole
/// flow list as tokens of about 130 bytes before it tells of the first, so that 4 MB of "1," already take half a gigabyte.
constexpr std::size_t kLargestYamlBytes = 4u << 20;
constexpr int kDeepestYaml = 64;
constexpr std::size_t kMostYamlNodes = 500000;

/// Reads one document. UserError with line and column for anything that is not well-formed YAML, not one document, or beyond
/// the limits. Duplicate keys are kept: the tables refuse them with a better message.
Value parseYaml(const std::string& text, const std::string& fileName);

/// Reads a file; `askedAt` is where its name was written (for a missing file), `shown` its name in places where that is another.
Value loadYaml(const std::filesystem::path& file, const Location& askedAt, std::string* textOut = nullptr, const std::string& shown = "");

/// "path.to.key=value" applied to a tree: list items by number (from 0) or by their `name`. The value is YAML.
/// UserError where the path leads nowhere.
void applyOverride(Value& tree, const std::string& assignment);

}  // namespace pitviper
