#pragma once
// Text by printf's rules, of any length.
#include <cstdio>
#include <string>

namespace pitviper {

std::string print(const char* format, auto... values) {
  std::string text(static_cast<std::size_t>(std::snprintf(nullptr, 0, format, values...)), '\0');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

}  // namespace pitviper
