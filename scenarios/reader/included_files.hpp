#pragma once
// The files that a scenario is put together from: where they may lie, what they hold, and what they were.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenarios/reader/scenario_reader.hpp"
#include "sim/parameters/value.hpp"

namespace pitviper {

/// Files that include each other.
constexpr int kDeepestInclude = 16;

struct IncludedFile {
  std::filesystem::path path;    ///< links resolved
  std::filesystem::path folder;  ///< as it was named
  std::string shown;             ///< its name in places
  Value tree;
};

/// A file that is being read, and those that asked for it.
struct FileChain {
  const FileChain* above = nullptr;
  std::filesystem::path path;
  std::string shown;
  int depth = 0;
};

class IncludedFiles {
 public:
  /// `scenario`: its file's name as in places, in the folder `base`. Errors: UserError for a root that is no folder.
  IncludedFiles(const std::string& scenario, const std::filesystem::path& base, const Libraries& libraries, const std::vector<std::filesystem::path>& roots);

  /// The file that `name` names: from the folder of the file in which the name is written, else from a root, else from a library. It stays where it is.
  /// Errors: UserError at the name for one that lies elsewhere (links resolved), is no YAML, or is among `chain` already, or for too many or too large files.
  const IncludedFile& open(const Value& name, bool extends, const FileChain& chain);

  const FileChain& scenario() const { return scenario_; }
  /// Of a file by its name in places; null for the scenario's own.
  const std::filesystem::path* folderOf(const std::string& shown) const;
  /// Texts of all of them in the order in which they were asked for.
  const std::string& identity() const { return identity_; }

 private:
  struct Root {
    std::filesystem::path path;  ///< links resolved
    std::string shown;
    bool searched = false;
  };
  std::filesystem::path find(const Value& name, bool extends, const FileChain& chain) const;
  bool isAllowed(const std::filesystem::path& path) const;
  [[noreturn]] void refuse(const Value& name, bool extends) const;

  std::filesystem::path base_;
  FileChain scenario_;
  std::vector<Root> roots_;
  std::map<std::filesystem::path, IncludedFile> files_;
  std::map<std::string, std::filesystem::path> folders_;
  std::string identity_;
  std::size_t values_ = 0;
};

/// The chain with one more.
FileChain chainOf(const IncludedFile& file, const FileChain& above);

/// Values in a tree.
std::size_t sizeOf(const Value& value);

}  // namespace pitviper
