#pragma once
// What a stream comes to at its end: for people, for programs, as a page.
#include <filesystem>
#include <string>
#include <vector>

#include "sim/image/atomic_file.hpp"
#include "sim/run/stream_loop.hpp"

namespace pitviper {

struct StreamResult {
  StreamReport report;
  std::vector<SinkCounts> sinks;
  std::map<std::string, std::uint64_t> commands;  ///< CommandInbox::counts()
  std::string renderer, scenario, late;           ///< `late`: the policy's word
  double rate_hz = 0.0;
  /// Frames that became nothing: of the loop, and of sinks that neither passed on nor skipped them.
  std::uint64_t unaccounted() const;
};

std::string streamSummary(const StreamResult& result);
std::string streamJson(const StreamResult& result);
/// stream.json and stream.html in a folder that is there. Errors: OutputError, and what `mayReplace` throws.
void writeStreamReport(const StreamResult& result, const std::string& mark, const std::filesystem::path& folder, const MayReplace& mayReplace);

/// Rows of a table for a terminal, in columns that stand below each other.
std::string alignedTable(const std::vector<std::vector<std::string>>& rows);

}  // namespace pitviper
