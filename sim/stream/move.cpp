// Moves a body: where it is, how it is turned, how fast it goes on.
#include "sim/scene/placement.hpp"
#include "sim/stream/command_models.hpp"

namespace pitviper {

CommandModel moveCommand() {
  std::vector<Parameter> keys = {required(text("entity", "name of a body; what it carries goes with it"))};
  for (auto& p : commandedPoseParameters()) keys.push_back(std::move(p));
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const int e = entityOf(r, sim);
    const CommandedPose pose = readCommandedPose(r, sim.frame, sim.entities[static_cast<size_t>(e)].parent >= 0);
    if (!pose.position && !pose.attitude) throw UserError(r.where(), "a move to nowhere", "a position, or an attitude", "add 'position:'");
    return [=](Courses& courses, double at_s) {
      if (pose.position) move(courses, e, at_s, *pose.position, pose.velocity);
      if (pose.attitude) courses.orientations[e] = [q = orientationFrom(*pose.attitude)](double) { return q; };
    };
  };
  return {"move", "Puts a body somewhere else, or turns it. A position or an attitude that is not given stays as the scenario has it.", keys, read};
}

}  // namespace pitviper
