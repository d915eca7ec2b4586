#include "scenarios/session/expected_worlds.hpp"

#include <algorithm>

#include "sim/parameters/fingerprint.hpp"

namespace pitviper {
namespace {

bool sameThings(const Simulation& a, const Simulation& b) {
  const auto alike = [](const auto& x, const auto& y, auto same) { return std::equal(x.begin(), x.end(), y.begin(), y.end(), same); };
  return alike(a.entities, b.entities, [](const Entity& x, const Entity& y) { return x.name == y.name && x.surfaces.size() == y.surfaces.size(); }) &&
         alike(a.lights, b.lights, [](const PointLight& x, const PointLight& y) { return x.name == y.name; }) &&
         alike(a.cameras, b.cameras, [](const Camera& x, const Camera& y) { return x.name == y.name && x.mount.carrier == y.mount.carrier; });
}

Pose within(const Pose& carrier, const Pose& pose) {
  const glm::dquat back = glm::conjugate(carrier.orientation);
  return {back * (pose.position - carrier.position), back * pose.orientation};
}

template <class T>
Course<T> always(const T& value) {
  return [value](double) { return value; };
}

/// All that a command can say of a world.
void say(const Simulation& sim, const WorldState& world, Courses& courses) {
  for (std::size_t e = 0; e < sim.entities.size(); ++e) {
    const int number = static_cast<int>(e), parent = sim.entities[e].parent;
    Pose pose = world.bodyPose(e);
    if (parent >= 0) pose = within(world.bodyPose(static_cast<std::size_t>(parent)), pose);
    courses.positions[number] = always(pose.position);
    courses.orientations[number] = always(pose.orientation);
    for (std::size_t s = 0; s < sim.entities[e].surfaces.size(); ++s)
      if (sim.entities[e].surfaces[s].temperatureTexture < 0) courses.temperatures_K[{number, static_cast<int>(s)}] = always(world.temperatures_K[e][s]);
  }
  for (std::size_t l = 0; l < sim.lights.size(); ++l) courses.lightLevels[static_cast<int>(l)] = always(world.lightLevels[l]);
  for (const Camera& c : sim.cameras) {
    if (c.follower) continue;
    const CameraState at = cameraAt(c, world);
    Pose pose = at.pose;
    if (c.mount.carrier >= 0) pose = within(world.bodyPose(static_cast<std::size_t>(c.mount.carrier)), pose);
    courses.cameraPositions[c.name] = always(pose.position);
    courses.cameraOrientations[c.name] = always(pose.orientation);
    courses.focalLengths_m[c.name] = always(at.pinhole.focalLength_m);
  }
}

std::string wordsOf(const Simulation& sim, const WorldState& world) {
  Courses courses;
  say(sim, world, courses);
  Fingerprint f;
  f.add("a world of a variation");
  for (const auto& [e, c] : courses.positions) f.add(c(0.0));
  for (const auto& [e, c] : courses.orientations) f.add(c(0.0));
  for (const auto& [s, c] : courses.temperatures_K) f.add(c(0.0));
  for (const auto& [l, c] : courses.lightLevels) f.add(c(0.0));
  for (const auto& [n, c] : courses.cameraPositions) f.add(c(0.0));
  for (const auto& [n, c] : courses.cameraOrientations) f.add(c(0.0));
  for (const auto& [n, c] : courses.focalLengths_m) f.add(c(0.0));
  return f.bytes();
}

}  // namespace

Simulation withFramesOf(const Simulation& sim, const std::vector<ExpectedWorld>& worlds) {
  Simulation result = sim;
  int frame = 0;
  for (const ExpectedWorld& w : worlds) {
    if (!sameThings(sim, *w.of)) continue;
    if (frame == 0) result.commands.clear();
    result.commands.push_back(
        {sim.time.at(frame), wordsOf(*w.of, w.state), [of = w.of, state = w.state](Courses& courses, double) { say(*of, state, courses); }});
    ++frame;
  }
  if (frame > 0) result.time.frames = frame;
  return result;
}

}  // namespace pitviper
