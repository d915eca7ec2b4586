#pragma once
// Which model of a registry a user's map asks for.
#include "sim/parameters/registry.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

/// The model whose name stands under `key` ("command": "there is no command 'x'"). UserError where there is no such key or model.
template <class Model>
const Model& askedModel(const Registry<Model>& registry, const Value& map, const std::string& key) {
  std::vector<std::string> names;
  std::string all;
  for (const Model& m : registry.all()) names.push_back(m.name), all += (all.empty() ? "" : ", ") + m.name;
  const std::string expected = all.empty() ? "none: this program has no " + key : "one of " + all;
  const Value* word = asMap(map, "a " + key).find(key);
  if (!word) throw UserError(map.where, "missing key '" + key + "'", expected, "add '" + key + ":'");
  const std::string name = readText(*word, key);
  if (const Model* model = registry.named(name)) return *model;
  const std::string near = nearestWord(name, names);
  throw UserError(word->where, "there is no " + key + " '" + name.substr(0, 60) + "'", expected, near.empty() ? "choose one" : "did you mean '" + near + "'?");
}

}  // namespace pitviper
