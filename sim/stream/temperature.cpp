// Heats or cools a body or one of its parts.
#include "sim/stream/command_models.hpp"

namespace pitviper {

CommandModel temperatureCommand() {
  const std::vector<Parameter> keys = {required(text("entity", "name of a body")), text("part", "of its shape; all of them unless given"),
                                       required(within(number("value", "K", "temperature"), 0.0, 1e5))};
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const int e = entityOf(r, sim);
    const Entity& entity = sim.entities[static_cast<size_t>(e)];
    if (r.given("part") && sim.mediumOf(entity))
      throw UserError(r.where("part"), "a part of '" + entity.name + "', which a medium fills", "the temperature of the whole body", "remove 'part'");
    std::vector<int> surfaces;
    std::vector<std::string> names;
    for (size_t s = 0; s < entity.surfaces.size(); ++s) {
      names.push_back(entity.mesh->parts[entity.surfaces[s].meshPart].name);
      if (r.given("part") && names.back() != r.text("part")) continue;
      if (entity.surfaces[s].temperatureTexture >= 0)
        throw UserError(r.where(), "the temperature of part '" + names.back() + "' of '" + entity.name + "' is a texture", "a part with one temperature",
                        "name another part, or give it a number in the scenario");
      surfaces.push_back(static_cast<int>(s));
    }
    if (surfaces.empty()) throw unknownWord(r.where("part"), "'" + entity.name + "' has no part", r.text("part"), names);
    return [=, value_K = r.number("value")](Courses& courses, double) {
      for (int s : surfaces) courses.temperatures_K[{e, s}] = [=](double) { return value_K; };
    };
  };
  return {"temperature", "Gives a body, or one of its parts, a temperature.", keys, read};
}

}  // namespace pitviper
