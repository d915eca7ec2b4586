// Turns a detector's gain up or down.
#include "sim/stream/command_models.hpp"

namespace pitviper {

CommandModel gainCommand() {
  const std::vector<Parameter> keys = {required(text("camera", "name of a camera with a detector")),
                                       required(within(above(number("factor", "", "of the gain that its detector has in the scenario"), 0.0), 0.0, 1e4))};
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const Camera& camera = sim.cameras[static_cast<size_t>(cameraOf(r, sim))];
    if (!detectorOf(camera))
      throw UserError(r.where("camera"), "camera '" + camera.name + "' has no detector", "a camera with 'stages: [{stage: detector, ...}]'",
                      "name another, or add one");
    return [name = camera.name, factor = r.number("factor")](Courses& courses, double) { courses.gains[name] = [factor](double) { return factor; }; };
  };
  return {"gain", "Counts per electron of a camera's detector, as a factor of its own; what frames say of their calibration follows.", keys, read};
}

}  // namespace pitviper
