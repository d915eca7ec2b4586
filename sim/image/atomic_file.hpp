#pragma once
// Output files appear under their final name only when whole.
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace pitviper {

/// The machine could not store a result: disk full, no such folder, no permission. One line: path, what failed, the
/// system's reason, what to do.
class OutputError : public std::runtime_error {
 public:
  /// `errorNumber` is an errno value; 0 leaves the system's reason and its advice out.
  OutputError(const std::filesystem::path& path, const std::string& what, int errorNumber, const std::string& fix = "");
};

/// Writes `bytes` to `.<name>.partial` in the same folder and renames it to `path` when whole; an existing regular file is
/// replaced. The folder must exist. One writer per path at a time.
/// Errors: OutputError; then neither the temporary nor a changed `path` is left.
void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes);

/// Creates `folder` with its parents where missing. Errors: OutputError if it is no folder or cannot be written to.
void ensureWritableFolder(const std::filesystem::path& folder);

/// Writes all of `bytes` to an open descriptor, going on after short writes and interrupts; `path` is only for the message.
/// Errors: OutputError.
void writeAll(int descriptor, std::string_view bytes, const std::filesystem::path& path);

}  // namespace pitviper
