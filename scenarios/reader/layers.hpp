#pragma once
// Files put over each other: what `include` and `extends` at the top of a file mean.
#include <map>
#include <memory>

#include "scenarios/reader/included_files.hpp"

namespace pitviper {

class Layers {
 public:
  explicit Layers(IncludedFiles& files) : files_(files) {}

  /// The tree over all that it includes and extends; these two keys are gone. Maps are put together key by key, the tree's own keys win over those of files
  /// that it includes, later ones of these over earlier, and all over what it extends. In a scenario (not in a file of an entry) its lists are joined, those
  /// of included files first; `sinks` are not, nor lists below. Nothing is expanded.
  /// Errors: UserError where files cannot be included, two entries of a joined list have one name, or there are too many values.
  Value merged(Value own, bool scenario, const FileChain& chain);

  /// The same of a file, kept.
  const Value& of(const IncludedFile& file, bool scenario, const FileChain& above);

 private:
  void count(const Value& more, const Location& where);

  IncludedFiles& files_;
  std::map<std::pair<std::filesystem::path, bool>, std::unique_ptr<const Value>> done_;
  std::size_t merged_ = 0;
};

/// Takes a key out of a map; null where it has none. Two of one name: UserError.
std::unique_ptr<Value> takeKey(Value& map, const std::string& key);

}  // namespace pitviper
