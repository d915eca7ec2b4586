// Flies a body along its route at another speed.
#include <mutex>

#include "sim/scene/route_clock.hpp"
#include "sim/stream/command_models.hpp"

namespace pitviper {
namespace {

/// The same command is carried out for every picture: its clock is made once.
struct KeptClock {
  std::mutex mutex;
  double from_s = 0.0;
  std::shared_ptr<const RouteClock> clock;
};

}  // namespace

CommandModel speedCommand() {
  const std::vector<Parameter> keys = {required(text("entity", "name of a body that moves along a route")),
                                       required(within(number("value", "m/s", "along the route, from where it is then on; 0 stops it there"), 0.0, 1e5))};
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const int e = entityOf(r, sim);
    const Entity& entity = sim.entities[static_cast<size_t>(e)];
    if (entity.motion.waypoints().size() < 2 && !entity.motion.path())
      throw UserError(r.where("entity"), "'" + entity.name + "' has no route", "a body with 'motion' or a flight",
                      "give it one, or use 'command: move' with a velocity");
    return [e, motion = entity.motion, speed = r.number("value"), kept = std::make_shared<KeptClock>()](Courses& courses, double at_s) {
      const auto before = courses.routeTimes_s.find(e);
      const double from_s = before == courses.routeTimes_s.end() ? at_s : before->second(at_s);
      std::shared_ptr<const RouteClock> clock;
      {
        const std::lock_guard lock(kept->mutex);
        if (!kept->clock || kept->from_s != from_s) kept->clock = std::make_shared<const RouteClock>(motion, from_s);
        kept->from_s = from_s;
        clock = kept->clock;
      }
      courses.routeTimes_s[e] = [clock, from_s, speed, at_s](double t) {
        return t >= at_s ? clock->at(speed, t - at_s) : from_s - (at_s - t) * clock->rate(speed);
      };
      courses.positions.erase(e);  // back on the route, where a move has taken it off
      courses.orientations.erase(e);
      courses.moved.erase(e);
    };
  };
  return {"speed",
          "Flies a body along its route at another speed; its attitude is that which it has there. A body that has been moved or turned by commands is back on "
          "its route.",
          keys, read};
}

}  // namespace pitviper
