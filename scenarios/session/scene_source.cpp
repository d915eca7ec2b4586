#include "scenarios/session/scene_source.hpp"

#include <algorithm>

#include "scenarios/reader/yaml_tree.hpp"
#include "sim/parameters/table.hpp"
#include "sim/run/memory_need.hpp"

namespace pitviper {
namespace {

std::string nameOfItem(const Value& item) {
  const Value* name = item.kind == Value::Kind::Map ? item.find("name") : nullptr;
  return name ? name->text : std::string();
}

}  // namespace

ExpandedScenario SceneSource::expanded() const {
  std::string whole;
  if (!text) loadYaml(file, {file, 0, 0, -1}, &whole);
  return expandScenario(text ? *text : whole, file, folder(), sets, findLibraries(), roots);
}

Simulation SceneSource::read(const ExpandedScenario& expanded) const {
  Simulation sim = readExpanded(expanded, file, folder(), findLibraries());
  refuseBeyondMemory(sim);
  return sim;
}

std::filesystem::path SceneSource::folder() const { return text ? base : std::filesystem::path(file).parent_path(); }

SceneSource SceneSource::with(const std::string& path, const std::string& yaml) const {
  SceneSource other = *this;
  std::erase_if(other.sets, [&](const std::string& s) { return s.starts_with(path + "="); });
  other.sets.push_back(path + "=" + yaml);
  return other;
}

const Value& valueAt(const Value& tree, const std::string& path) {
  const Value* at = &tree;
  std::string there;
  for (std::size_t from = 0; from <= path.size();) {
    const std::size_t dot = std::min(path.find('.', from), path.size());
    const std::string word = path.substr(from, dot - from);
    const Value* next = nullptr;
    std::vector<std::string> names;
    if (at->kind == Value::Kind::Map) {
      next = at->find(word);
      for (const auto& [key, value] : at->entries) names.push_back(key);
    } else if (at->kind == Value::Kind::List) {
      for (std::size_t k = 0; k < at->items.size(); ++k) {
        names.push_back(nameOfItem(at->items[k]));
        if (names.back().empty()) names.back() = std::to_string(k);
        if (word == names.back() || word == std::to_string(k)) next = next ? next : &at->items[k];
      }
    }
    if (!next) throw unknownWord({"scene['" + path + "']", 0, 0, -1}, there.empty() ? "the scenario has no" : "there is no '" + there + "' with", word, names);
    there += (there.empty() ? "" : ".") + word;
    at = next;
    from = dot + 1;
  }
  return *at;
}

}  // namespace pitviper
