#include "sim/stream/command_models.hpp"

#include <algorithm>

#include "sim/parameters/asked_model.hpp"
#include "sim/scene/placement.hpp"

namespace pitviper {
namespace {

template <class T>
int named(const Record& r, const char* key, const std::vector<T>& all) {
  const std::string name = r.text(key);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return static_cast<int>(i);
    if (std::find(names.begin(), names.end(), all[i].name) == names.end()) names.push_back(all[i].name);  // points of a lamp share its name
  }
  throw unknownWord(r.where(key), std::string("there is no ") + key, name, names);
}

}  // namespace

Registry<CommandModel>& commandModels() {
  static Registry<CommandModel> all("command", {moveCommand(), speedCommand(), throttleCommand(), ejectCommand(), lookCommand(), pointCommand(),
                                                temperatureCommand(), lightCommand(), triggerCommand(), gainCommand()});
  return all;
}

ParameterTable commandTable(const CommandModel& model) {
  return tableOf(model, "command",
                 {within(number("at", "s", "simulation time from which on it holds, until another says otherwise (in a scenario: its first frame)"),
                         -kLongestTime_s, kLongestTime_s)});
}

Command readCommand(const Value& value, const Simulation& simulation, double now_s) {
  const CommandModel& model = askedModel(commandModels(), value, "command");
  const ParameterTable table = commandTable(model);
  const Record r(value, table);
  return {r.given("at") ? r.number("at") : now_s, wordsOf(value), model.read(r, simulation)};
}

Command commandOf(const std::vector<std::pair<std::string, std::string>>& words, const std::string& from, const Simulation& simulation, double now_s) {
  Value map;
  map.kind = Value::Kind::Map;
  map.where.file = from;
  for (const auto& [key, text] : words) {
    Value word;
    word.kind = Value::Kind::Scalar;
    word.text = text;
    word.where = map.where;
    map.entries.emplace_back(key, word);
    map.keyPlaces.push_back(map.where);
  }
  return readCommand(map, simulation, now_s);
}

int entityOf(const Record& r, const Simulation& sim) { return named(r, "entity", sim.entities); }
int lightOf(const Record& r, const Simulation& sim) { return named(r, "light", sim.lights); }
int plumeOf(const Record& r, const Simulation& sim) {
  std::vector<std::string> names;
  const std::string asked = r.text("plume");
  for (size_t f = 0; f < sim.fields.size(); ++f) {
    if (!sim.fields[f].source->hasThrottle()) continue;
    if (sim.fields[f].name == asked) return static_cast<int>(f);
    names.push_back(sim.fields[f].name);
  }
  throw unknownWord(r.where("plume"), "there is no plume of an engine or nozzle", asked, names);
}
int storeOf(const Record& r, const Simulation& sim) { return named(r, "flare", sim.stores); }
int cameraOf(const Record& r, const Simulation& sim) { return named(r, "camera", sim.cameras); }

}  // namespace pitviper
