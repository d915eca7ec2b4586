#pragma once
// A user's input as a tree in which every node knows its place. Any format can be read into it; the models read from it.
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/parameters/error.hpp"

namespace pitviper {

struct Value {
  enum class Kind { Null, Scalar, List, Map };

  Kind kind = Kind::Null;
  Location where;
  bool quoted = false;                                 ///< a scalar in quotes
  std::string text;                                    ///< Scalar
  std::vector<Value> items;                            ///< List
  std::vector<std::pair<std::string, Value>> entries;  ///< Map, in the order written
  std::vector<Location> keyPlaces;                     ///< Map, one per entry

  const Value* find(std::string_view key) const {
    for (const auto& [name, value] : entries)
      if (name == key) return &value;
    return nullptr;
  }
  Value* find(std::string_view key) { return const_cast<Value*>(std::as_const(*this).find(key)); }

  /// What it is, in a user's words.
  const char* kindName() const {
    switch (kind) {
      case Kind::Null:
        return "nothing";
      case Kind::Scalar:
        return "a single value";
      case Kind::List:
        return "a list";
      case Kind::Map:
        return "a map of keys";
    }
    return "";
  }
};

/// A value as text, places left out: two with the same words are the same.
std::string wordsOf(const Value& value);

}  // namespace pitviper
