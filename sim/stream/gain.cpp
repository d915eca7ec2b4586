// Turns a detector's gain up or down.
#include <algorithm>

#include "sim/stream/command_models.hpp"

namespace pitviper {

CommandModel gainCommand() {
  const std::vector<Parameter> keys = {required(text("camera", "name of a camera with a detector")),
                                       required(within(above(number("factor", "", "of the gain that its detector has in the scenario"), 0.0), 0.0, 1e4)),
                                       text("channel", "of this one's own detector alone; unless given of all of the camera's")};
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const Camera& camera = sim.cameras[static_cast<size_t>(cameraOf(r, sim))];
    if (!hasDetector(camera))
      throw UserError(r.where("camera"), "camera '" + camera.name + "' has no detector", "a camera with 'stages: [{stage: detector, ...}]'",
                      "name another, or add one");
    const double factor = r.number("factor");
    if (!r.given("channel"))
      return [name = camera.name, factor](Courses& courses, double) {
        courses.gains[name] = [factor](double) { return factor; };
        std::erase_if(courses.channelGains, [&](const auto& own) { return own.first.first == name; });
      };
    const std::string channel = r.text("channel");
    std::vector<std::string> names;
    for (const auto& [own, what] : camera.ownChannels)
      if (what.hasDetector) names.push_back(own);
    if (std::find(names.begin(), names.end(), channel) == names.end())
      throw UserError(r.where("channel"), "camera '" + camera.name + "' has no channel '" + channel + "' with a detector of its own",
                      names.empty() ? "a channel with 'stages: [{stage: detector, ...}]'" : "'" + names.front() + "', for instance",
                      "remove 'channel', or name one that has");
    return [name = camera.name, factor, channel](Courses& courses, double) { courses.channelGains[{name, channel}] = [factor](double) { return factor; }; };
  };
  return {"gain",
          "Counts per electron of a camera's detector, or of a channel's own, as a factor of what it has; what frames say of their calibration follows.", keys,
          read};
}

}  // namespace pitviper
