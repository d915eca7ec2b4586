#pragma once
// Names that a part of a scenario can use with a dollar: parameters of its file, numbers of repeated entries.
#include <map>
#include <optional>
#include <string>

#include "scenarios/reader/included_files.hpp"

namespace pitviper {

struct Variable {
  const Value* raw = nullptr;  ///< as written, until it is asked for
  std::optional<Value> value;  ///< expanded
  Location keyPlace;
  bool busy = false;  ///< is being expanded
  bool used = false;
  unsigned long loops = 0;  ///< bits of the repeated entries on whose number it depends
};

struct Scope {
  Scope* outer = nullptr;            ///< of the same file
  const FileChain* chain = nullptr;  ///< of that file
  std::map<std::string, Variable, std::less<>> variables;

  /// The variable and the scope that has it; nulls where there is none.
  std::pair<Variable*, Scope*> find(std::string_view name);
  /// All names, those like `word` first.
  std::vector<std::string> namesLike(std::string_view word) const;
};

/// Error: UserError for what a parameter cannot be called.
void checkName(const std::string& name, const Location& where);

}  // namespace pitviper
