#include "sim/model/world.hpp"

#include <algorithm>
#include <stdexcept>

namespace pitviper {
namespace {

/// The scenario's commands from one on, as far as a time; returns the first that is left.
std::size_t carryOut(const Simulation& sim, std::size_t next, double time_s, Courses& courses) {
  for (; next < sim.commands.size() && sim.commands[next].at_s <= time_s + kSameTick * sim.time.step_s; ++next)
    sim.commands[next].change(courses, sim.commands[next].at_s);
  return next;
}

template <class Map, class Key, class Other>
auto valueOf(const Map& courses, const Key& key, double time_s, const Other& otherwise) {
  const auto set = courses.find(key);
  return set == courses.end() ? otherwise() : set->second(time_s);
}

WorldState stateOf(const Simulation& sim, const Courses& courses, double time_s) {
  WorldState state;
  state.time_s = time_s;
  const auto carried = [&state](int carrier, const Pose& own) { return carrier >= 0 ? composed(state.entities[static_cast<size_t>(carrier)], own) : own; };
  for (const Entity& e : sim.entities) {  // a parent comes before its children
    const int index = static_cast<int>(state.entities.size());
    Pose own = e.motion.at(time_s);
    own.position = valueOf(courses.positions, index, time_s, [&] { return own.position; });
    own.orientation = valueOf(courses.orientations, index, time_s, [&] { return own.orientation; });
    state.entities.push_back(carried(e.parent, own));
    std::vector<double>& temperatures = state.temperatures_K.emplace_back();
    for (const Surface& s : e.surfaces)
      temperatures.push_back(valueOf(courses.temperatures_K, std::pair(index, static_cast<int>(temperatures.size())), time_s, [&] { return s.temperature_K; }));
  }
  for (const PointLight& l : sim.lights) {
    const int index = static_cast<int>(state.lights.size());
    state.lights.push_back(carried(l.parent, l.motion.at(time_s)).position);
    state.lightLevels.push_back(valueOf(courses.lightLevels, index, time_s, [&] { return l.levelAt(time_s); }));
  }
  for (const auto& [camera, course] : courses.cameraPositions) state.cameras[camera].position = course(time_s);
  for (const auto& [camera, course] : courses.cameraOrientations) state.cameras[camera].orientation = course(time_s);
  for (const auto& [camera, course] : courses.focalLengths_m) state.cameras[camera].focalLength_m = course(time_s);
  for (const auto& [camera, course] : courses.exposures_s) state.cameras[camera].exposure_s = course(time_s);
  for (const auto& [camera, course] : courses.gains) state.cameras[camera].gain = course(time_s);
  return state;
}

Pose poseOf(const Mount& mount, const CameraChange* change, const WorldState& state) {
  Pose pose = mount.motion.at(state.time_s);
  if (change && change->position) pose.position = *change->position;
  if (change && change->orientation) pose.orientation = *change->orientation;
  if (mount.carrier >= 0) pose = composed(state.entities[static_cast<size_t>(mount.carrier)], pose);
  if (change && change->orientation) return pose;
  if (mount.lookAtEntity >= 0 || mount.looksAtPoint) {
    const glm::dvec3 target = mount.looksAtPoint ? mount.lookAtPoint : state.entities[static_cast<size_t>(mount.lookAtEntity)].position;
    const glm::dvec3 line = target - pose.position;
    if (glm::dot(line, line) > 0.0) pose.orientation = orientationAlong(line);
  }
  return pose;
}

}  // namespace

WorldState advance(const Simulation& simulation, double time_s) { return World(simulation).at(time_s); }

void World::apply(const Command& command, int tick) {
  const double at_s = simulation_.time.at(tick);
  if (at_s < since_s_) throw std::invalid_argument("a command for tick " + std::to_string(tick) + ", and a later one has had some");
  since_s_ = at_s;
  next_ = carryOut(simulation_, next_, at_s, courses_);
  command.change(courses_, std::min(command.at_s, at_s));
}

WorldState World::at(double time_s) const {
  Courses courses = courses_;
  carryOut(simulation_, next_, time_s, courses);
  return stateOf(simulation_, courses, time_s);
}

CameraState cameraAt(const Camera& camera, const WorldState& state) {
  const auto found = state.cameras.find(camera.name);
  const CameraChange* change = found == state.cameras.end() ? nullptr : &found->second;
  CameraState at{poseOf(camera.mount, change, state), camera.pinhole, camera.exposure_s, 1.0};
  if (change && change->focalLength_m) at.pinhole.focalLength_m = *change->focalLength_m;
  if (change && change->exposure_s) at.exposure_s = *change->exposure_s;
  if (change && change->gain) at.gain = *change->gain;
  return at;
}

}  // namespace pitviper
