#include "scenarios/sweep/yaml_line.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace pitviper {
namespace {

bool isPlainInFlow(std::string_view text) {
  const auto isAlnum = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  if (text.empty() || text == "null" || text.back() == ' ') return false;
  const bool sign = text[0] == '-' || text[0] == '+';
  if (!isAlnum(text[sign ? 1 : 0])) return false;  // behind a lone sign stands the text's end
  return std::all_of(text.begin(), text.end(), [&](char c) { return isAlnum(c) || std::string_view(" _.+-*/^()%").find(c) != std::string_view::npos; });
}

std::string scalarInFlow(std::string_view text, bool quoted) {
  if (!quoted && isPlainInFlow(text)) return std::string(text);
  std::string out = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') out += "\\n";
    else if (c == '\r') out += "\\r";
    else if (c == '\t') out += "\\t";
    else out += c;
  }
  return out + "\"";
}

}  // namespace

std::string yamlLine(const Value& value) {
  std::string text;
  switch (value.kind) {
    case Value::Kind::Null:
      return "~";
    case Value::Kind::Scalar:
      return scalarInFlow(value.text, value.quoted);
    case Value::Kind::List:
      for (const Value& item : value.items) text += (text.empty() ? "" : ", ") + yamlLine(item);
      return "[" + text + "]";
    case Value::Kind::Map:
      for (const auto& [key, item] : value.entries) text += (text.empty() ? "" : ", ") + scalarInFlow(key, false) + ": " + yamlLine(item);
      return "{" + text + "}";
  }
  return "";
}

}  // namespace pitviper
