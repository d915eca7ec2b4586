#include "scenarios/session/same_drawing.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

#include "scenarios/session/same_bodies.hpp"
#include "sim/model/scene_fingerprint.hpp"

namespace pitviper {
namespace {

/// Of a scene whose meshes and textures are another's, and need not be gone through.
std::string bytesOf(Simulation sim, const Camera& camera) {
  static const auto none = std::make_shared<const Mesh>();
  for (Entity& e : sim.entities) e.mesh = none;
  sim.textures.clear();
  Fingerprint f;
  addTo(f, sim);
  addTo(f, camera);
  return f.bytes();
}

/// What a world holds, by lists of a scenario and keys of their entries.
const std::map<std::string, std::set<std::string>> kOfWorld = {
    {"entities", {"position", "heading", "pitch", "roll", "geodetic", "motion", "temperature"}},
    {"lights", {"position", "geodetic", "motion", "level"}},
    {"cameras", {"position", "heading", "pitch", "roll", "geodetic", "motion", "look_at", "field_of_view", "focal_length"}},
};

bool isOfWorld(const std::vector<std::string>& path) {
  if (path.size() < 3) return false;
  const auto list = kOfWorld.find(path[0]);
  if (list == kOfWorld.end()) return false;
  if (path[0] == "entities" && path[2] == "parts") return path.size() > 4 && path[4] == "temperature";
  return list->second.count(path[2]) > 0;
}

Value mixed(const Value& value, const Value& world, std::vector<std::string>& path) {
  Value result = value;
  if (value.kind != world.kind) return result;
  for (std::size_t k = 0; k < value.items.size() && value.items.size() == world.items.size(); ++k) {
    path.push_back(std::to_string(k));
    result.items[k] = mixed(value.items[k], world.items[k], path);
    path.pop_back();
  }
  if (value.kind != Value::Kind::Map) return result;
  result.entries.clear(), result.keyPlaces.clear();
  const auto add = [&](const Value& from, std::size_t k, const Value& what) {
    result.entries.emplace_back(from.entries[k].first, what);
    result.keyPlaces.push_back(from.keyPlaces[k]);
  };
  for (std::size_t k = 0; k < value.entries.size(); ++k) {
    const auto& [key, own] = value.entries[k];
    const Value* other = world.find(key);
    path.push_back(key);
    if (!isOfWorld(path)) add(value, k, other ? mixed(own, *other, path) : own);
    else if (other) add(value, k, *other);
    path.pop_back();
  }
  for (std::size_t k = 0; k < world.entries.size(); ++k) {
    path.push_back(world.entries[k].first);
    if (isOfWorld(path) && !value.find(world.entries[k].first)) add(world, k, world.entries[k].second);
    path.pop_back();
  }
  return result;
}

}  // namespace

bool differInWorldAlone(const Simulation& drawn, const Simulation& other, std::size_t camera) {
  if (drawn.entities.size() != other.entities.size() || drawn.lights.size() != other.lights.size() || drawn.cameras.size() != other.cameras.size())
    return false;
  if (!sameBodies(drawn, other)) return false;
  Simulation same = other;
  for (std::size_t e = 0; e < same.entities.size(); ++e) {
    const Entity& before = drawn.entities[e];
    Entity& now = same.entities[e];
    now.motion = before.motion;
    now.flight = before.flight;
    if (now.surfaces.size() != before.surfaces.size()) return false;
    for (std::size_t s = 0; s < now.surfaces.size(); ++s) {
      // A texture's temperatures are no number that a world holds.
      if (now.surfaces[s].temperatureTexture >= 0 || before.surfaces[s].temperatureTexture >= 0) continue;
      now.surfaces[s].temperature = before.surfaces[s].temperature;
      now.surfaces[s].temperature_K = before.surfaces[s].temperature_K;
    }
  }
  for (std::size_t l = 0; l < same.lights.size(); ++l) {
    same.lights[l].mount = drawn.lights[l].mount;
    same.lights[l].level = drawn.lights[l].level;
  }
  Camera eye = other.cameras[camera];
  const Camera& before = drawn.cameras[camera];
  // What points it keeps its own record of where it stands.
  if (!eye.follower && !before.follower) {
    eye.mount = before.mount;
    eye.pinhole.focalLength_m = before.pinhole.focalLength_m;
    if (eye.ownChannels.empty() && eye.stages.empty()) eye.exposure_s = before.exposure_s;
  }
  return bytesOf(same, eye) == bytesOf(drawn, before);
}

Value withWorldOf(const Value& tree, const Value& world) {
  std::vector<std::string> path;
  return mixed(tree, world, path);
}

WorldState worldFor(const Camera& other, WorldState state) {
  if (other.follower) return state;
  const CameraState at = cameraAt(other, state);
  CameraChange& change = state.cameras[other.name];
  change.pose = at.pose;
  change.focalLength_m = at.pinhole.focalLength_m;
  change.exposure_s = at.exposures_s.common;
  return state;
}

}  // namespace pitviper
