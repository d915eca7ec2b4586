// Lights a lamp's course: a flare that burns when it is told to.
#include "sim/stream/command_models.hpp"

namespace pitviper {

CommandModel triggerCommand() {
  const std::vector<Parameter> keys = {required(text("light", "name of a point light with a course of its level"))};
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const int l = lightOf(r, sim);
    const PointLight& light = sim.lights[static_cast<size_t>(l)];
    if (light.level.empty())
      throw UserError(r.where("light"), "light '" + light.name + "' has no course that could begin", "a light with 'level: [[0 s, 0], [0.2 s, 1], ...]'",
                      "give it one, or use 'command: light' with a level");
    return [l, light](Courses& courses, double at_s) {
      courses.lightLevels[l] = [light, at_s](double t) { return light.levelAt(light.level.begin_s() + t - at_s); };
    };
  };
  return {"trigger", "Begins the course of a point light's level now, whatever it did before: a flare goes off.", keys, read};
}

}  // namespace pitviper
