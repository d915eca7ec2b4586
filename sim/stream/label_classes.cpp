#include "sim/stream/label_classes.hpp"

#include <algorithm>

namespace pitviper {
namespace {

bool isNamedBy(const std::string& wish, const std::string& body) {
  return wish.ends_with('*') ? body.starts_with(std::string_view(wish).substr(0, wish.size() - 1)) : wish == body;
}

/// Null where there is none.
const ClassWishes::value_type* wishOf(const ClassWishes& wishes, const std::string& body) {
  if (const auto own = wishes.find(body); own != wishes.end()) return &*own;
  const ClassWishes::value_type* best = nullptr;
  for (const auto& wish : wishes)
    if (isNamedBy(wish.first, body) && (!best || wish.first.size() > best->first.size())) best = &wish;
  return best;
}

}  // namespace

Parameter categoriesParameter() {
  return map(
      "categories",
      "body: what it is called, `{jet: aircraft, guard_*: person, decoy: null}`; `*` at the end stands for any end. Bodies without an entry are classes by "
      "their own names, but terrain and what carries the cameras are left out; null leaves a body out");
}

ClassWishes readClasses(const Record& r, const Simulation& sim) {
  ClassWishes wishes;
  if (!r.given("categories")) return wishes;
  std::vector<std::string> bodies;
  for (const Entity& e : sim.entities) bodies.push_back(e.name);
  const Value& map = asMap(r.value("categories"), "categories");
  for (std::size_t k = 0; k < map.entries.size(); ++k) {
    const auto& [body, value] = map.entries[k];
    if (std::none_of(bodies.begin(), bodies.end(), [&wish = body](const std::string& name) { return isNamedBy(wish, name); }))
      throw unknownWord(map.keyPlaces[k], "there is no entity", body, bodies);
    std::optional<std::string> name;
    if (value.kind != Value::Kind::Null) {
      name = readText(value, "a category");
      if (name->empty() || std::any_of(name->begin(), name->end(), [](unsigned char c) { return c < 32; }))
        throw UserError(value.where, "a category that is no line of text", "a word, such as 'aircraft', or null",
                        "write 'categories: {" + body + ": aircraft}'");
    }
    if (!wishes.emplace(body, name).second) throw UserError(map.keyPlaces[k], "a second category of '" + body + "'", "one", "remove one");
  }
  return wishes;
}

LabelClasses classesOf(const ClassWishes& wishes, const Simulation& sim, const std::vector<std::string>& cameras) {
  LabelClasses classes;
  for (std::size_t e = 0; e < sim.entities.size(); ++e) {
    const Entity& body = sim.entities[e];
    const bool carriesAll = std::all_of(sim.cameras.begin(), sim.cameras.end(), [&](const Camera& c) {
      return std::find(cameras.begin(), cameras.end(), c.name) == cameras.end() || c.mount.carrier == static_cast<int>(e);
    });
    const bool isTerrain = body.mesh && body.mesh->heightField;
    std::optional<std::string> name;
    if (const auto* wish = wishOf(wishes, body.name)) name = wish->second;
    else if (!isTerrain && !carriesAll) name = body.name;
    classes.bodies.push_back(body.name);
    if (!name) {
      classes.ofBody.push_back(-1);
      continue;
    }
    const auto at = std::find(classes.names.begin(), classes.names.end(), *name);
    classes.ofBody.push_back(static_cast<int>(at - classes.names.begin()));
    if (at == classes.names.end()) classes.names.push_back(*name);
  }
  return classes;
}

}  // namespace pitviper
