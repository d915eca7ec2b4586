#include "scenarios/import/import_yaml.hpp"

#include <charconv>

#include "sim/parameters/readable_text.hpp"

namespace pitviper {

std::string exactNumber(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return error == std::errc() ? std::string(text, end) : std::string();
}

double tidy(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 12);
  double rounded = value;
  if (error == std::errc()) std::from_chars(text, end, rounded);
  return rounded;
}

std::string quotedText(std::string_view text) {
  std::string whole;
  while (!text.empty()) {
    const std::size_t length = utf8Length(text);
    if (length > 0) {
      whole += text.substr(0, length);
    } else {
      const auto byte = static_cast<unsigned char>(text.front());
      whole += static_cast<char>(0xc0 | byte >> 6);
      whole += static_cast<char>(0x80 | (byte & 0x3f));
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  whole = readable(whole);
  while (!whole.empty() && whole.back() == ' ') whole.pop_back();
  std::string out = "\"";
  for (char c : whole) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string rowsOfNumbers(const std::vector<std::vector<double>>& rows) {
  std::string out = "[";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    out += k == 0 ? "[" : k % 6 ? ", [" : ",\n         [";
    for (std::size_t c = 0; c < rows[k].size(); ++c) out += (c ? ", " : "") + exactNumber(rows[k][c]);
    out += "]";
  }
  return out + "]";
}

}  // namespace pitviper
