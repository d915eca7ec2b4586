#pragma once
// Output files appear under their final name only when whole.
#include <filesystem>
#include <functional>
#include <memory>
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

/// Called where a file of the name exists; throws what is to be said where it must stay.
using MayReplace = std::function<void(const std::filesystem::path&)>;

/// Writes `bytes` to a temporary of its own in the same folder and renames it to `path` when whole. The folder must exist. An existing regular file is
/// replaced, if `mayReplace` (where given) lets it. Any number of processes and threads may write the same path at once: one of their files stands there,
/// whole, at every moment.
/// Errors: OutputError, and what `mayReplace` throws; then neither the temporary nor a changed `path` is left.
void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes, const MayReplace& mayReplace = {});

/// A file that grows while a program runs: under a temporary name in the same folder, which goes with the object, until keep().
class GrowingFile {
 public:
  /// Errors: OutputError.
  explicit GrowingFile(const std::filesystem::path& path);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;
  /// All of `bytes`, or none of them. Errors: OutputError.
  void append(std::string_view bytes);
  /// Gives it its name. Errors: OutputError, and what `mayReplace` throws.
  void keep(const MayReplace& mayReplace = {});

 private:
  class Temporary;
  std::unique_ptr<Temporary> file_;
  std::filesystem::path path_;
  std::size_t size_ = 0;
};

/// What processes that were killed left in `folder`. Files that a living process is writing stay.
void removeAbandonedTemporaries(const std::filesystem::path& folder);

/// For a program that is about to end by a signal: removes the temporaries of all its threads, and lets no thread begin another.
void removeOpenTemporaries();

/// Creates `folder` with its parents where missing; removes what killed processes left in it. Errors: OutputError if it is no folder or cannot be written to.
void ensureWritableFolder(const std::filesystem::path& folder);

/// Writes all of `bytes` to an open descriptor, going on after short writes and interrupts; `path` is only for the message.
/// Errors: OutputError.
void writeAll(int descriptor, std::string_view bytes, const std::filesystem::path& path);

}  // namespace pitviper
