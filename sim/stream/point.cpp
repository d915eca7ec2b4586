// Demands a direction of a camera's gimbal.
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/stream/command_models.hpp"
#include "sim/world/world.hpp"

namespace pitviper {

void requireTakesCommands(const Camera& camera, const Location& where) {
  if (camera.follower && camera.follower->takesCommands) return;
  if (!camera.follower)
    throw UserError(where, "camera '" + camera.name + "' has no gimbal", "a camera with a 'gimbal:' that commands drive",
                    "use 'look', or give it a 'gimbal: {driver: commands}'");
  throw UserError(where, "the gimbal of camera '" + camera.name + "' is driven by " + camera.follower->driver, "one that commands drive",
                  "write 'driver: commands' under its 'gimbal:'");
}

CommandModel pointCommand() {
  const std::vector<Parameter> keys = {required(text("camera", "name of a camera whose gimbal has `driver: commands`")),
                                       within(number("azimuth", "rad", "to its base, positive to the left"), -100, 100),
                                       within(number("elevation", "rad", "to its base, positive up; 0 unless given"), -0.5 * kPi, 0.5 * kPi),
                                       within(vector3("direction", "", "instead: east, north, up in the local frame, of any length"), -1e9, 1e9)};
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const Camera& camera = sim.cameras[static_cast<size_t>(cameraOf(r, sim))];
    requireTakesCommands(camera, r.where("camera"));
    Pointing p;
    if (r.given("direction")) {
      for (const char* key : {"azimuth", "elevation"})
        if (r.given(key)) throw UserError(r.where(key), std::string("a direction and an ") + key, "one of the two", "remove one");
      p.direction = r.vector("direction");
      if (!(glm::length(p.direction) > 0.0)) throw UserError(r.where("direction"), "a direction of length 0", "a direction such as [0, 1, 0.1]", "correct it");
    } else {
      if (!r.given("azimuth")) throw UserError(r.where(), "a point to nowhere", "'azimuth' and 'elevation', or a 'direction'", "add 'azimuth: 10 deg'");
      const double a = r.number("azimuth"), e = r.given("elevation") ? r.number("elevation") : 0.0;
      p.inBase = true;
      p.direction = {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
    }
    return [p, name = camera.name](Courses& courses, double at_s) {
      Pointing now = p;
      now.at_s = at_s;
      addPointing(courses, name, now);
    };
  };
  return {"point",
          "Demands a direction of a camera's gimbal, which turns there within its limits. One that a stream gets without `at` is seen in the next frame, as "
          "what a centroid finds in the frame before.",
          keys, read};
}

}  // namespace pitviper
