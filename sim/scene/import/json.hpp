#pragma once
// Reads JSON (RFC 8259) into a tree; for the headers of glTF files. Throws ImportFailure with line and column.
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace pitviper {

struct Json {
  enum class Kind { Null, Bool, Number, String, Array, Object };
  Kind kind = Kind::Null;
  double number = 0.0;  ///< a Bool's is 0 or 1
  std::string text;
  std::vector<Json> items;
  std::map<std::string, Json, std::less<>> members;
  std::size_t offset = 0;  ///< in the text

  /// Member of an object, or null.
  const Json* find(std::string_view name) const {
    const auto found = members.find(name);
    return kind == Kind::Object && found != members.end() ? &found->second : nullptr;
  }
};

/// `base` is the text's offset in the file; if above 0, places are given as bytes, else as line and column.
Json parseJson(const std::string& file, std::string_view text, std::size_t base);

/// The tree as JSON text, on one line.
std::string writeJson(const Json& json);

/// Fails at an offset of that text.
[[noreturn]] void failInJson(const std::string& file, std::string_view text, std::size_t base, std::size_t offset, const std::string& wrong,
                             const std::string& expected);

}  // namespace pitviper
