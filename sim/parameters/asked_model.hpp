#pragma once
// Which model of a registry a user's map asks for.
#include "sim/parameters/registry.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

/// The model whose name stands under `key` ("command": "there is no command 'x'"). UserError where there is no such key or model.
template <class Model>
const Model& askedModel(const Registry<Model>& registry, const Value& map, const std::string& key) {
  std::vector<std::string> names;
  for (const Model& m : registry.all()) names.push_back(m.name);
  const Value* word = asMap(map, "a " + key).find(key);
  if (!word) throw UserError(map.where, "missing key '" + key + "'", "one of " + listed(names), "add '" + key + ":'");
  const std::string name = readText(*word, key);
  if (const Model* model = registry.named(name)) return *model;
  throw unknownWord(word->where, "there is no " + key, name, names);
}

/// All keys of such a map: `key` itself with the model's name, `common` ones, and the model's.
template <class Model>
ParameterTable tableOf(const Model& model, const std::string& key, const std::vector<Parameter>& common = {}) {
  ParameterTable t{key + ": " + model.name, model.description, {required(text(key, "`" + model.name + "`"))}};
  t.parameters.insert(t.parameters.end(), common.begin(), common.end());
  t.parameters.insert(t.parameters.end(), model.parameters.begin(), model.parameters.end());
  return t;
}

}  // namespace pitviper
