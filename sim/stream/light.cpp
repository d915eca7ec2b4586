// Sets the level of a point light.
#include "sim/stream/command_models.hpp"

namespace pitviper {

CommandModel lightCommand() {
  const std::vector<Parameter> keys = {required(text("light", "name of a point light")),
                                       required(within(number("level", "", "factor of its intensity"), 0.0, 1e6))};
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    return [l = lightOf(r, sim), level = r.number("level")](Courses& courses, double) { courses.lightLevels[l] = [=](double) { return level; }; };
  };
  return {"light", "Sets the level of a point light, in place of its own course.", keys, read};
}

}  // namespace pitviper
