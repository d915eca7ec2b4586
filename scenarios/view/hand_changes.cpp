#include "scenarios/view/hand_changes.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

bool samePose(const Pose& a, const Pose& b) { return a.position == b.position && a.orientation == b.orientation; }

/// The frame that has begun by a time.
int frameBegun(const TimeAxis& time, double time_s) { return std::max(0, static_cast<int>(std::floor((time_s - time.start_s) / time.step_s + kSameTick))); }

/// Of a flown camera that looked at something: a point on its line of sight.
constexpr double kAhead_m = 1000.0;

std::string vectorText(const glm::dvec3& v) { return print("[%.7g m, %.7g m, %.7g m]", v.x, v.y, v.z); }

std::string degrees(double rad) { return print("%.6g deg", rad * 180.0 / kPi); }

}  // namespace

bool HandChanges::operator==(const HandChanges& other) const {
  return focalLengths_m == other.focalLengths_m && temperatures_K == other.temperatures_K && lightLevels == other.lightLevels &&
         std::equal(flown.begin(), flown.end(), other.flown.begin(), other.flown.end(),
                    [](const auto& a, const auto& b) { return a.first == b.first && samePose(a.second, b.second); });
}

StateAt worldWith(const Simulation& sim, const HandChanges& hands, double time_s) {
  auto world = std::make_shared<World>(sim);
  Command command;
  command.at_s = sim.time.at(frameBegun(sim.time, time_s));
  command.change = [hands](Courses& courses, double) {
    const auto always = [](double value) { return [value](double) { return value; }; };
    for (const auto& [camera, f] : hands.focalLengths_m) courses.focalLengths_m[camera] = always(f);
    for (const auto& [surface, t] : hands.temperatures_K) courses.temperatures_K[surface] = always(t);
    for (const auto& [light, level] : hands.lightLevels) courses.lightLevels[light] = always(level);
  };
  if (hands.any()) world->apply(command, frameBegun(sim.time, time_s));
  return [world, flown = hands.flown, &sim](double t) {
    WorldState state = world->at(t);
    for (const Camera& c : sim.cameras)
      if (const auto pose = flown.find(c.name); pose != flown.end()) state = pointed(std::move(state), c, pose->second);
    return state;
  };
}

std::vector<YamlChange> keysOf(const Simulation& sim, const HandChanges& hands, double time_s) {
  std::vector<YamlChange> keys;
  const WorldState state = advance(sim, time_s);
  for (const Camera& c : sim.cameras) {
    const std::string path = "cameras." + c.name + ".";
    if (const auto flown = hands.flown.find(c.name); flown != hands.flown.end()) {
      Pose pose = flown->second;
      const glm::dvec3 ahead = pose.position + kAhead_m * (pose.orientation * glm::dvec3(1.0, 0.0, 0.0));
      if (c.mount.carrier >= 0) {
        const Pose carrier = state.bodyPose(static_cast<std::size_t>(c.mount.carrier));
        pose = {glm::conjugate(carrier.orientation) * (pose.position - carrier.position), glm::conjugate(carrier.orientation) * pose.orientation};
      }
      keys.push_back({path + "position", vectorText(pose.position)});
      const bool looks = c.mount.looksAtPoint || c.mount.lookAtEntity >= 0 || c.mount.lookAtLight >= 0;
      if (looks) {
        keys.push_back({path + "look_at", vectorText(ahead)});
      } else {
        const Attitude a = attitudeOf(pose.orientation);
        // On a carrier headings count from its own forward axis, else clockwise from north.
        keys.push_back({path + "heading", degrees(c.mount.carrier >= 0 ? a.heading_rad - 0.5 * kPi : a.heading_rad)});
        keys.push_back({path + "pitch", degrees(a.pitch_rad)});
        keys.push_back({path + "roll", degrees(a.roll_rad)});
      }
    }
    if (const auto f = hands.focalLengths_m.find(c.name); f != hands.focalLengths_m.end())
      keys.push_back({path + "field_of_view", degrees(2.0 * std::atan(0.5 * c.pinhole.width * c.pinhole.pitchX_m / f->second))});
  }
  for (const auto& [of, kelvin] : hands.temperatures_K) {
    const Entity& e = sim.entities[static_cast<std::size_t>(of.first)];
    const std::uint32_t part = e.surfaces[static_cast<std::size_t>(of.second)].meshPart;
    const bool named = e.surfaces.size() > 1 && e.mesh && part < e.mesh->parts.size();
    keys.push_back({"entities." + e.name + (named ? ".parts." + e.mesh->parts[part].name : std::string()) + ".temperature", print("%.6g K", kelvin)});
  }
  for (const auto& [light, level] : hands.lightLevels)
    keys.push_back({"lights." + sim.lights[static_cast<std::size_t>(light)].name + ".level", print("%.6g", level)});
  return keys;
}

}  // namespace pitviper
