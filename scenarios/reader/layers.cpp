#include "scenarios/reader/layers.hpp"

#include <string_view>
#include <unordered_map>

#include "scenarios/reader/yaml_tree.hpp"

namespace pitviper {
namespace {

/// Values that are moved about in putting files together: a few times what a scenario may hold.
constexpr std::size_t kMostMerged = 4 * kMostYamlNodes;
constexpr std::size_t kMostIncludes = 256;

/// First of each key.
std::unordered_map<std::string, size_t> placesOf(const Value& map) {
  std::unordered_map<std::string, size_t> places;
  for (size_t k = 0; k < map.entries.size(); ++k) places.emplace(map.entries[k].first, k);
  return places;
}

void append(Value& map, Value&& from, size_t k) {
  map.entries.push_back(std::move(from.entries[k]));
  map.keyPlaces.push_back(from.keyPlaces[k]);
}

void putUnder(Value& own, Value&& below) {
  const auto places = placesOf(own);
  for (size_t k = 0; k < below.entries.size(); ++k) {
    const auto found = places.find(below.entries[k].first);
    if (found == places.end()) {  // a key twice in the other stays twice: the reader tells
      append(own, std::move(below), k);
      continue;
    }
    Value& mine = own.entries[found->second].second;
    Value& other = below.entries[k].second;
    if (mine.kind == Value::Kind::Map && other.kind == Value::Kind::Map) putUnder(mine, std::move(other));
  }
}

/// Keys that the tree does not have.
void putMissing(Value& own, Value&& below) {
  const auto places = placesOf(own);
  for (size_t k = 0; k < below.entries.size(); ++k)
    if (places.count(below.entries[k].first) == 0) append(own, std::move(below), k);
}

/// Parameters are values: each whole from one file.
void putParameters(Value& own, Value& below) {
  Value* mine = own.find("parameters");
  Value* other = below.find("parameters");
  if (!mine || !other || mine->kind != Value::Kind::Map || other->kind != Value::Kind::Map) return;
  putMissing(*mine, std::move(*other));
  other->entries.clear();
  other->keyPlaces.clear();
}

void join(const std::string& key, Value& own, Value&& below) {
  std::unordered_map<std::string, Location> names;
  const auto nameOf = [](const Value& item) -> const Value* {
    const Value* name = item.kind == Value::Kind::Map ? item.find("name") : nullptr;
    return name && name->kind == Value::Kind::Scalar ? name : nullptr;
  };
  for (const Value& item : below.items)
    if (const Value* name = nameOf(item)) names.emplace(name->text, name->where);
  for (const Value& item : own.items)
    if (const Value* name = nameOf(item))
      if (const auto found = names.find(name->text); found != names.end())
        throw UserError(name->where, "'" + name->text.substr(0, 60) + "' in " + key + " stands at " + found->second.text() + " too, which is included",
                        "each name once", "rename or remove one of the two");
  for (Value& item : own.items) below.items.push_back(std::move(item));
  own.items = std::move(below.items);
}

void putScenarioUnder(Value& own, Value&& below) {
  putParameters(own, below);
  const auto places = placesOf(own);
  for (size_t k = 0; k < below.entries.size(); ++k) {
    const std::string key = below.entries[k].first;
    const auto found = places.find(key);
    if (found == places.end()) {
      append(own, std::move(below), k);
      continue;
    }
    Value& mine = own.entries[found->second].second;
    Value& other = below.entries[k].second;
    const bool list = mine.kind == Value::Kind::List, otherList = other.kind == Value::Kind::List;
    if (key == "parameters" || key == "sinks") continue;
    if (list && otherList) join(key, mine, std::move(other));
    else if (list != otherList && mine.kind != Value::Kind::Null && other.kind != Value::Kind::Null)
      throw UserError(mine.where,
                      "'" + key.substr(0, 60) + "' is " + mine.kindName() + ", and " + other.kindName() + " at " + other.where.text() + ", which is included",
                      "two lists or none", "write both as lists");
    else if (mine.kind == Value::Kind::Map && other.kind == Value::Kind::Map) putUnder(mine, std::move(other));
  }
}

}  // namespace

std::unique_ptr<Value> takeKey(Value& map, const std::string& key) {
  std::unique_ptr<Value> taken;
  for (size_t k = 0; k < map.entries.size();) {
    if (map.entries[k].first != key) {
      ++k;
      continue;
    }
    if (taken) throw UserError(map.keyPlaces[k], "duplicate key '" + key + "'", "each key once", "remove one of the two");
    taken = std::make_unique<Value>(std::move(map.entries[k].second));
    map.entries.erase(map.entries.begin() + static_cast<std::ptrdiff_t>(k));
    map.keyPlaces.erase(map.keyPlaces.begin() + static_cast<std::ptrdiff_t>(k));
  }
  return taken;
}

void Layers::count(const Value& more, const Location& where) {
  merged_ += sizeOf(more);
  if (merged_ > kMostMerged)
    throw UserError(where, "the files put together hold more than " + std::to_string(kMostMerged) + " values", "fewer values",
                    "include each file once, and put large tables into CSV files");
}

Value Layers::merged(Value own, bool scenario, const FileChain& chain) {
  if (own.kind != Value::Kind::Map) return own;
  const auto include = takeKey(own, "include");
  const auto extends = takeKey(own, "extends");
  if (include) {
    std::vector<const Value*> names;
    if (include->kind == Value::Kind::List)
      for (const Value& name : include->items) names.push_back(&name);
    else names.push_back(include.get());
    if (names.size() > kMostIncludes)
      throw UserError(include->where, std::to_string(names.size()) + " files are included", "at most " + std::to_string(kMostIncludes),
                      "include files that include others");
    std::unique_ptr<Value> below;
    for (const Value* name : names) {
      const IncludedFile& file = files_.open(*name, false, chain);
      Value layer = of(file, scenario, chain);
      if (layer.kind != Value::Kind::Map)
        throw UserError(
            name->where, "'" + file.shown + "' holds " + layer.kindName(), "a map of keys at the top of a file that is included at the top",
            layer.kind == Value::Kind::List ? "include it as an entry of a list: '- include: " + name->text.substr(0, 60) + "'" : "see scenarios/README.md");
      count(layer, name->where);
      if (below) {
        if (scenario) putScenarioUnder(layer, std::move(*below));
        else putParameters(layer, *below), putUnder(layer, std::move(*below));
      }
      below = std::make_unique<Value>(std::move(layer));
    }
    if (below) {
      if (scenario) putScenarioUnder(own, std::move(*below));
      else putParameters(own, *below), putUnder(own, std::move(*below));
    }
  }
  if (extends) {
    const IncludedFile& file = files_.open(*extends, true, chain);
    Value layer = of(file, scenario, chain);
    if (layer.kind != Value::Kind::Map)
      throw UserError(layer.where, "a scenario is " + std::string(layer.kindName()), "a map of keys", "see scenarios/README.md");
    count(layer, extends->where);
    putParameters(own, layer);
    putMissing(own, std::move(layer));
  }
  return own;
}

const Value& Layers::of(const IncludedFile& file, bool scenario, const FileChain& above) {
  auto& kept = done_[{file.path, scenario}];
  if (!kept) {
    count(file.tree, file.tree.where);
    kept = std::make_unique<const Value>(merged(file.tree, scenario, chainOf(file, above)));
  }
  return *kept;
}

}  // namespace pitviper
