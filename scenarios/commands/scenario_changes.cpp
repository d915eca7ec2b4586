#include "scenarios/commands/scenario_changes.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <set>

#include "scenarios/reader/expand.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/units.hpp"
#include "sim/plan/plan_cache.hpp"

namespace pitviper {
namespace {

struct Edit {
  std::string set, words;
};
using Edits = std::vector<Edit>;

const Value* valueAt(const Value* from, std::initializer_list<const char*> keys) {
  for (const char* key : keys) from = from ? from->find(key) : nullptr;
  return from;
}

bool isText(const Value* value) { return value && value->kind == Value::Kind::Scalar; }

std::optional<WrittenQuantity> quantityIn(const Value* value) { return isText(value) ? splitQuantity(value->text) : std::nullopt; }

std::string quantityText(double value, const std::string& unit) { return print("%.9g%s%s", value, unit.empty() ? "" : " ", unit.c_str()); }

Edit replaced(const std::string& path, const std::string& shown, const std::string& before, const std::string& after) {
  return {path + "=" + after, shown + " " + before + " -> " + after};
}

/// A number with a unit becomes another by `change`, which gets it in `canonical`.
void addNumber(Edits& edits, const Value* value, const std::string& path, const std::string& shown, const char* canonical,
               const std::function<double(double)>& change) {
  const auto written = quantityIn(value);
  const auto now = written ? convert(*written, canonical) : std::nullopt;
  if (now) edits.push_back(replaced(path, shown, value->text, quantityText(change(*now), canonical)));
}

/// A list of a scenario, its entries by number; those that a camera looks at first.
class Entries {
 public:
  Entries(const Value& tree, const char* key) : key_(key), list_(tree.find(key)) {
    if (!list_ || list_->kind != Value::Kind::List) return;
    std::set<std::string> lookedAt;
    if (const Value* cameras = tree.find("cameras"); cameras && cameras->kind == Value::Kind::List)
      for (const Value& c : cameras->items)
        if (const Value* target = c.find("look_at"); isText(target)) lookedAt.insert(target->text);
    for (std::size_t k = 0; k < list_->items.size(); ++k) order_.push_back(k);
    std::stable_partition(order_.begin(), order_.end(), [&](std::size_t k) {
      const Value* name = list_->items[k].find("name");
      return isText(name) && lookedAt.count(name->text) > 0;
    });
  }
  template <class Of>
  void each(const Of& of) const {
    for (std::size_t k : order_) {
      const Value* name = list_->items[k].find("name");
      of(list_->items[k], print("%s.%zu", key_, k), std::string(key_) + "." + (isText(name) ? name->text : std::to_string(k)));
    }
  }

 private:
  const char* key_;
  const Value* list_;
  std::vector<std::size_t> order_;
};

/// A number, the first of a course, or the offset of a skin that the air heats.
void addWarmer(Edits& edits, const Value& owner, const std::string& path, const std::string& shown) {
  const Value* given = owner.find("temperature");
  if (!given) return;
  const std::string here = path + ".temperature", said = shown + ".temperature";
  const auto warmer = [](double kelvin) { return kelvin + 10.0; };
  addNumber(edits, given, here, said, "K", warmer);
  if (given->kind == Value::Kind::List && !given->items.empty() && given->items[0].items.size() == 2)
    addNumber(edits, &given->items[0].items[1], here + ".0.1", said + ".0.1", "K", warmer);
  if (!given->find("recovery")) return;
  if (const Value* offset = given->find("offset")) addNumber(edits, offset, here + ".offset", said + ".offset", "K", warmer);
  else edits.push_back(replaced(here + ".offset", said + ".offset", "0 K", "10 K"));
}

Edits temperatures(const Value& tree, const Simulation&) {
  Edits edits;
  const Entries entities(tree, "entities");
  entities.each([&](const Value& e, const std::string& path, const std::string& shown) { addWarmer(edits, e, path, shown); });
  entities.each([&](const Value& e, const std::string& path, const std::string& shown) {
    if (const Value* parts = e.find("parts"); parts && parts->kind == Value::Kind::Map)
      for (const auto& [part, value] : parts->entries) addWarmer(edits, value, path + ".parts." + part, shown + ".parts." + part);
  });
  if (const Value* ground = tree.find("ground")) addWarmer(edits, *ground, "ground", "ground");
  return edits;
}

Edits visibilities(const Value& tree, const Simulation&) {
  Edits edits;
  const Value* air = tree.find("atmosphere");
  if (isText(air)) edits.push_back(replaced("atmosphere", "atmosphere", air->text, "{library: " + air->text + ", visibility: 15 km}"));
  addNumber(edits, valueAt(air, {"visibility"}), "atmosphere.visibility", "atmosphere.visibility", "km", [](double km) { return 0.75 * km; });
  if (edits.empty() && air) edits.push_back(replaced("atmosphere.visibility", "atmosphere.visibility", "", "15 km"));
  return edits;
}

Edits fieldsOfView(const Value& tree, const Simulation& sim) {
  Edits edits;
  const Entries cameras(tree, "cameras");
  cameras.each([&](const Value& c, const std::string& path, const std::string& shown) {
    addNumber(edits, c.find("field_of_view"), path + ".field_of_view", shown + ".field_of_view", "deg", [](double deg) { return 0.8 * deg; });
    addNumber(edits, c.find("focal_length"), path + ".focal_length", shown + ".focal_length", "mm", [](double mm) { return 1.25 * mm; });
  });
  // A camera of the library says neither.
  if (!sim.cameras.empty())
    edits.push_back(replaced("cameras.0.focal_length", "cameras." + sim.cameras[0].name + ".focal_length",
                             quantityText(1e3 * sim.cameras[0].pinhole.focalLength_m, "mm"),
                             quantityText(1.25e3 * sim.cameras[0].pinhole.focalLength_m, "mm")));
  return edits;
}

/// Every place below a value, in the order written.
void addPositions(Edits& edits, const Value& value, const std::string& path, const std::string& shown) {
  const auto further = [](double m) { return m + 1.0; };
  for (const auto& [key, inner] : value.entries) {
    const std::string here = path + "." + key, said = shown + "." + key;
    if (key == "position" && inner.kind == Value::Kind::List && inner.items.size() == 3)
      addNumber(edits, &inner.items[0], here + ".0", said + ".0", "m", further);
    else if (inner.kind != Value::Kind::Scalar) addPositions(edits, inner, here, said);
  }
  for (std::size_t k = 0; k < value.items.size(); ++k) addPositions(edits, value.items[k], print("%s.%zu", path.c_str(), k), print("%s.%zu", shown.c_str(), k));
}

Edits positions(const Value& tree, const Simulation&) {
  Edits edits;
  for (const char* list : {"entities", "lights", "cameras"})
    Entries(tree, list).each([&](const Value& e, const std::string& path, const std::string& shown) { addPositions(edits, e, path, shown); });
  return edits;
}

Edits otherMaterials(const Value& tree, const Simulation&) {
  Edits edits;
  Entries(tree, "entities").each([&](const Value& e, const std::string& path, const std::string& shown) {
    const Value* material = e.find("material");
    if (!isText(material)) return;
    const bool isPaint = material->text == "olive_gloss_paint";
    edits.push_back(replaced(path + ".material", shown + ".material", material->text, isPaint ? "grey_aircraft_paint" : "olive_gloss_paint"));
  });
  return edits;
}

Edits accuracies(const Value& tree, const Simulation& sim) {
  Edits edits;
  const double now = sim.cameras.empty() ? 0.0 : sim.cameras[0].spectral.accuracy;
  if (!(now > 0.0)) return edits;
  const Value* given = tree.find("accuracy");
  const std::string path = given && given->kind == Value::Kind::Map ? "accuracy.asked" : "accuracy";
  edits.push_back(replaced(path, path, quantityText(100.0 * now, "%"), quantityText(50.0 * now, "%")));
  return edits;
}

struct ChangeKind {
  const char* name;
  Edits (*edits)(const Value& tree, const Simulation& sim);
  const char* without;  ///< what is said where there is no such edit
};

constexpr ChangeKind kKinds[] = {
    {"temperature", temperatures, "no body has a temperature that can be 10 K more"},
    {"visibility", visibilities, "there is no air with a visibility"},
    {"field_of_view", fieldsOfView, "no camera has a field of view that is one number"},
    {"position", positions, "nothing has a position of three numbers"},
    {"material", otherMaterials, "no body has a material of one name"},
    {"accuracy", accuracies, "no accuracy is asked for"},
};

/// Of what its pictures are made from.
std::vector<ContentKey> keysOf(const Simulation& sim) {
  std::vector<ContentKey> keys;
  for (const Camera& camera : sim.cameras) {
    const Camera drawn = drawnCamera(camera);
    keys.push_back(planKey(sim, {&drawn, nullptr}));
  }
  return keys;
}

}  // namespace

const std::vector<std::string>& scenarioChangeNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const ChangeKind& kind : kKinds) all.emplace_back(kind.name);
    return all;
  }();
  return names;
}

std::vector<ScenarioChange> changesOf(const ScenarioWish& scenario) {
  const Libraries libraries = findLibraries();
  const Simulation before = scenario.read();
  std::string text;
  loadYaml(scenario.file, {scenario.file, 0, 0, -1}, &text);
  const std::vector<ContentKey> keys = keysOf(before);
  const Value tree = expandScenario(text, scenario.file, std::filesystem::path(scenario.file).parent_path(), scenario.changes, libraries, scenario.roots).tree;
  std::vector<ScenarioChange> changes;
  for (const ChangeKind& kind : kKinds) {
    ScenarioChange change{kind.name, {}, kind.without};
    bool tried = false;
    for (const Edit& edit : kind.edits(tree, before)) {
      ScenarioWish edited = scenario;
      edited.changes.push_back(edit.set);
      std::string why;
      try {
        if (keysOf(edited.read()) == keys) why = edit.words + " changes nothing";
      } catch (const UserError& e) {
        why = e.what();
      }
      if (!why.empty()) {
        if (!tried) change.words = why;
        tried = true;
        continue;
      }
      change.sets = {edit.set};
      change.words = edit.words;
      break;
    }
    changes.push_back(std::move(change));
  }
  return changes;
}

}  // namespace pitviper
