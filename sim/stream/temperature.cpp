// Heats or cools a body or one of its parts.
#include <algorithm>
#include <cmath>

#include "sim/stream/command_models.hpp"

namespace pitviper {

CommandModel temperatureCommand() {
  const std::vector<Parameter> keys = {
      required(text("entity", "name of a body")), text("part", "of its shape; all of them unless given"),
      required(within(number("value", "K", "temperature"), 0.0, 1e5)),
      within(number("time_constant", "s",
                    "it comes near it as exp(-t/this) from what it has then, as the skin of an engine whose throttle is moved; unless given it has it at once"),
             1e-6, 1e6)};
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const int e = entityOf(r, sim);
    const Entity& entity = sim.entities[static_cast<size_t>(e)];
    if (r.given("part") && sim.mediumOf(entity))
      throw UserError(r.where("part"), "a part of '" + entity.name + "', which a medium fills", "the temperature of the whole body", "remove 'part'");
    std::vector<std::pair<int, Surface>> surfaces;
    std::vector<std::string> names;
    for (size_t s = 0; s < entity.surfaces.size(); ++s) {
      names.push_back(entity.mesh->parts[entity.surfaces[s].meshPart].name);
      if (r.given("part") && names.back() != r.text("part")) continue;
      if (entity.surfaces[s].temperatureTexture >= 0)
        throw UserError(r.where(), "the temperature of part '" + names.back() + "' of '" + entity.name + "' is a texture", "a part with one temperature",
                        "name another part, or give it a number in the scenario");
      surfaces.emplace_back(static_cast<int>(s), entity.surfaces[s]);
    }
    if (surfaces.empty()) throw unknownWord(r.where("part"), "'" + entity.name + "' has no part", r.text("part"), names);
    return [=, value_K = r.number("value"), slowness_s = r.given("time_constant") ? r.number("time_constant") : 0.0](Courses& courses, double at_s) {
      for (const auto& [s, surface] : surfaces) {
        auto& course = courses.temperatures_K[{e, s}];
        const double from_K = course ? course(at_s) : surface.temperatureAt_K(at_s);
        if (slowness_s > 0.0) course = [=](double t) { return value_K + (from_K - value_K) * std::exp(-std::max(t - at_s, 0.0) / slowness_s); };
        else course = [=](double) { return value_K; };
      }
    };
  };
  return {"temperature", "Gives a body, or one of its parts, a temperature.", keys, read};
}

}  // namespace pitviper
