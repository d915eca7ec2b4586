// Moves a body: where it is, how it is turned, how fast it goes on.
#include "sim/scene/placement.hpp"
#include "sim/stream/command_models.hpp"

namespace pitviper {

CommandModel moveCommand() {
  std::vector<Parameter> keys = {required(text("entity", "name of a body; what it carries goes with it"))};
  for (auto& p : positionParameters()) keys.push_back(std::move(p));
  keys.push_back(within(vector3("velocity", "m/s", "goes on from there; at rest unless given"), -1e6, 1e6));
  for (auto& p : attitudeParameters(kMostTurn_rad)) keys.push_back(std::move(p));
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const int e = entityOf(r, sim);
    const bool attached = sim.entities[static_cast<size_t>(e)].parent >= 0;
    const auto position = readPosition(r, sim.frame);
    const auto attitude = readAttitude(r, attached);
    if (!position && !attitude) throw UserError(r.where(), "a move to nowhere", "a position, or an attitude", "add 'position:'");
    if (!position && r.given("velocity"))
      throw UserError(r.where("velocity"), "a velocity without a position to go on from", "both", "add 'position:', or remove 'velocity'");
    const glm::dvec3 velocity = r.given("velocity") ? r.vector("velocity") : glm::dvec3(0.0);
    return [=](Courses& courses, double at_s) {
      if (position) courses.positions[e] = [=](double t) { return *position + (t - at_s) * velocity; };
      if (attitude) courses.orientations[e] = [q = orientationFrom(*attitude)](double) { return q; };
    };
  };
  return {"move", "Puts a body somewhere else, or turns it. What is not given stays as the scenario has it.", keys, read};
}

}  // namespace pitviper
