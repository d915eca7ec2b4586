#pragma once
// What bodies are called in a data set: classes that a detector is to tell apart.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/model/simulation.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

/// By a body's name, or, with `*` at the end, the beginning of those of several; none: left out. A whole name goes before a beginning, a longer one before a
/// shorter. Bodies without an entry are classes of their own.
using ClassWishes = std::map<std::string, std::optional<std::string>>;

struct LabelClasses {
  std::vector<std::string> names;   ///< in the order of the first body of each
  std::vector<int> ofBody;          ///< by index in Simulation::entities, into `names`; -1: left out
  std::vector<std::string> bodies;  ///< their names, by index

  /// Of the number that stands in truth.entity, which is an index plus one; -1: none.
  int of(int number) const { return number >= 1 && number <= static_cast<int>(ofBody.size()) ? ofBody[static_cast<std::size_t>(number) - 1] : -1; }
};

/// `categories`, and what a user wrote of it. Errors: UserError, where it names no body, or a class that is no line of text.
Parameter categoriesParameter();
ClassWishes readClasses(const Record& record, const Simulation& simulation);

/// Terrain, and what carries all of these cameras, are left out unless a wish names them.
LabelClasses classesOf(const ClassWishes& wishes, const Simulation& simulation, const std::vector<std::string>& cameras);

}  // namespace pitviper
