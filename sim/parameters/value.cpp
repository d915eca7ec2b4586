#include "sim/parameters/value.hpp"

namespace pitviper {

std::string wordsOf(const Value& v) {
  std::string words = std::to_string(static_cast<int>(v.kind)) + "'" + v.text + "'";
  for (const Value& item : v.items) words += "[" + wordsOf(item) + "]";
  for (const auto& [key, item] : v.entries) words += "{'" + key + "':" + wordsOf(item) + "}";
  return words;
}

}  // namespace pitviper
