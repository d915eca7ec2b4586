#include "sim/stream/json_value.hpp"

namespace pitviper {

Value valueOf(const nlohmann::ordered_json& json, const Location& where, int depth) {
  constexpr int kDeepest = 16;
  if (depth > kDeepest) throw UserError(where, "nested too deep", "a map of keys and values", "write one command a line");
  Value value;
  value.where = where;
  if (json.is_null()) return value;
  if (json.is_object()) {
    value.kind = Value::Kind::Map;
    for (const auto& [key, item] : json.items()) {
      value.entries.emplace_back(key, valueOf(item, where, depth + 1));
      value.keyPlaces.push_back(where);
    }
    return value;
  }
  if (json.is_array()) {
    value.kind = Value::Kind::List;
    for (const auto& item : json) value.items.push_back(valueOf(item, where, depth + 1));
    return value;
  }
  value.kind = Value::Kind::Scalar;
  value.quoted = json.is_string();
  value.text = json.is_string() ? json.get<std::string>() : json.dump();
  return value;
}

}  // namespace pitviper
