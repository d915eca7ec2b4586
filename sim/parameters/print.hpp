#pragma once
// Text by printf's rules, of any length.
#include <cstdarg>
#include <cstdio>
#include <string>

namespace pitviper {

__attribute__((format(printf, 1, 2))) inline std::string print(const char* format, ...) {
  va_list values, again;
  va_start(values, format);
  va_copy(again, values);
  std::string text(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, format, values)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  va_end(values);
  return text;
}

/// A number in a message: six digits.
inline std::string briefNumber(double v) { return print("%.6g", v); }

}  // namespace pitviper
