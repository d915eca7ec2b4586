#pragma once
// Text of unknown origin made fit for a message.
#include <cstddef>
#include <string>
#include <string_view>

namespace pitviper {

/// Length of the UTF-8 character at the front; 0 where there is none. Overlong forms, surrogates and values above U+10FFFF are none.
inline std::size_t utf8Length(std::string_view t) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(t[i]); };
  if (t.empty()) return 0;
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || t.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  const bool overlong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
  const bool beyond = (first == 0xed && byte(1) > 0x9f) || (first == 0xf4 && byte(1) > 0x8f);
  return overlong || beyond ? 0 : length;
}

/// One line of whole UTF-8 characters that a terminal shows as they are: control characters and marks that turn the direction of writing become blanks,
/// bytes that are no UTF-8 '?'; a character that was cut is left out.
inline std::string readable(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    std::size_t length = utf8Length(text);
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    if (length == 0) {
      length = 1;  // with what follows of a character that has lost its end
      const std::size_t whole = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
      const bool begins = byte(0) >= 0xc2 && byte(0) <= 0xf4;
      while (begins && length < whole && length < text.size() && (byte(length) & 0xc0) == 0x80) ++length;
      if (!begins) out += '?';
    } else {
      const bool control = byte(0) < 32 || byte(0) == 127 || (byte(0) == 0xc2 && byte(1) < 0xa0);
      // U+2028 to U+202E, U+2066 to U+2069
      const bool turns = length == 3 && byte(0) == 0xe2 &&
                         ((byte(1) == 0x80 && byte(2) >= 0xa8 && byte(2) <= 0xae) || (byte(1) == 0x81 && byte(2) >= 0xa6 && byte(2) <= 0xa9));
      out += control || turns ? std::string_view(" ") : text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  return out;
}

/// What a message may show of a file that need not be what its reader takes it for: the beginning of a word, a number or a unit, in quotes. It ends before
/// the first character that none of these has, so that nothing of a file of passwords is told.
inline std::string tokenOf(std::string_view text) {
  constexpr std::size_t kMost = 32;  // the longest honest ones: names of columns with their units
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
  std::size_t length = 0;
  while (length < text.size() && length < kMost) {
    const char c = text[length];
    const bool fits =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || std::string_view("_.,+-*%/()[]^ ").find(c) != std::string_view::npos;
    if (!fits) break;
    ++length;
  }
  return "'" + std::string(text.substr(0, length)) + (length < text.size() ? "...'" : "'");
}

}  // namespace pitviper
