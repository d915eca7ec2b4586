#include "atmosphere/json_places.hpp"

#include <algorithm>

namespace pitviper {
namespace {

class Walk {
 public:
  explicit Walk(std::string_view text) : text_(text) { blanks(); }

  size_t at() const { return at_; }

  /// Into the value of a key, or the entry of an index; stays where there is none.
  bool enter(const std::string& step) {
    const size_t here = at_;
    const char open = look();
    if (open != '{' && open != '[') return false;
    const char close = open == '{' ? '}' : ']';
    next();
    for (size_t i = 0; look() != close && at_ < text_.size(); ++i) {
      std::string key = std::to_string(i);
      if (open == '{') {
        const size_t from = at_;
        skip();
        key = text_.substr(from + 1, at_ - from);
        key.resize(key.rfind('"'));
        next();  // the colon
      }
      if (key == step) return true;
      skip();
      if (look() == ',') next();
    }
    at_ = here;
    return false;
  }

 private:
  char look() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r')) ++at_;
  }
  void next() {
    ++at_;
    blanks();
  }
  /// Over a whole value.
  void skip() {
    int depth = 0;
    do {
      const char c = look();
      if (c == '"') {
        while (++at_ < text_.size() && text_[at_] != '"')
          if (text_[at_] == '\\') ++at_;
        ++at_;
      } else if (c == '{' || c == '[' || c == '}' || c == ']') {
        depth += c == '{' || c == '[' ? 1 : -1;
        ++at_;
      } else if (c == ',' || c == ':') {
        ++at_;
      } else {
        at_ = std::min(text_.find_first_of(",:{}[]\" \t\r\n", at_), text_.size());
      }
      blanks();
    } while (depth > 0 && at_ < text_.size());
  }

  std::string_view text_;
  size_t at_ = 0;
};

}  // namespace

Location placeOfByte(std::string_view text, const std::string& file, size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const size_t line = before.rfind('\n');
  return {file, static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1,
          static_cast<int>(line == std::string_view::npos ? before.size() : before.size() - line - 1) + 1, -1};
}

Location placeInJson(std::string_view text, const std::string& file, std::span<const std::string> way) {
  Walk walk(text);
  for (const std::string& step : way)
    if (!walk.enter(step)) break;
  return placeOfByte(text, file, walk.at());
}

}  // namespace pitviper
