#pragma once
// Where the values of a parsed YAML text begin and end in its characters.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sim/parameters/value.hpp"

namespace pitviper {

/// Where a value stands: within brackets or not, and how far the lines are indented of the map or list that it is an entry of.
struct YamlContext {
  bool inFlow = false;
  std::size_t indent = 0;
};

/// Offsets into a text that parseYaml() has read. Each value and key begins at its place; the ends are scanned for from there. What a value has in front
/// of it (an anchor, a tag) begins at its place too.
class YamlPlaces {
 public:
  explicit YamlPlaces(std::string_view text);

  /// Behind an `&anchor` and a `!tag`, and the blanks and comments behind these.
  std::size_t start(const Value& value) const { return afterProperties(at(value.where)); }
  /// Behind its last character. Not for one that is empty.
  std::size_t end(const Value& value, const YamlContext& context) const;

  /// Where a key ends: behind its colon if it has one.
  struct Key {
    std::size_t end = 0;
    bool colon = false;
  };
  Key key(const Location& place, bool inFlow) const;
  /// Behind the dash of an item of a list that is written with dashes.
  std::size_t afterDash(const Value& list, std::size_t item) const;

  /// Of what is within a map or list that stands in `context`.
  YamlContext within(const Value& map, const YamlContext& context) const;
  bool hasBrackets(const Value& value) const;

  /// Names of what it carries, "" for none.
  std::string_view anchor(const Value& value) const;
  std::string_view alias(const Location& place) const;
  /// Nothing is written where it stands, not even '~': its place is then that of something else.
  bool isEmpty(const Value& value) const;

 private:
  char charAt(std::size_t i) const { return i < text_.size() ? text_[i] : '\n'; }
  std::size_t at(const Location& place) const;
  std::size_t afterProperties(std::size_t from) const;
  std::size_t afterBlanks(std::size_t from) const;
  std::size_t column(std::size_t offset) const;
  std::size_t wordEnd(std::size_t from) const;
  std::size_t quotedEnd(std::size_t from) const;
  std::size_t plainEnd(std::size_t from, const YamlContext& context) const;
  std::size_t literalEnd(std::size_t from, std::size_t indent) const;
  std::size_t flowEnd(std::size_t from) const;

  std::string_view text_;
  std::vector<std::size_t> lines_;  ///< where each begins
};

}  // namespace pitviper
