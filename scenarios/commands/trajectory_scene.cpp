#include "scenarios/commands/trajectory_scene.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "sim/parameters/print.hpp"

namespace pitviper {

FlownScene flownScene(const Simulation& sim, const History& history, const std::vector<Encounter>& encounters, const std::string& title) {
  FlownScene scene;
  scene.title = title;
  double first = INFINITY, last = -INFINITY;
  std::set<std::string> drawn;
  for (const HistoryPath& path : history.paths()) {
    const bool isCamera = path.kind == "camera";
    FlownPath flown{path.name, path.time_s, {}, isCamera};
    for (const auto& pose : path.poses) flown.position_m.push_back(pose ? pose->position : glm::dvec3(NAN));
    if (!path.time_s.empty()) first = std::min(first, path.time_s.front()), last = std::max(last, path.time_s.back());
    const auto camera = std::find_if(sim.cameras.begin(), sim.cameras.end(), [&](const Camera& c) { return isCamera && c.name == path.name; });
    // One that a body carries flies that body's way.
    if (camera != sim.cameras.end() && camera->mount.carrier >= 0) continue;
    if (!isCamera) drawn.insert(path.name);
    scene.paths.push_back(std::move(flown));
  }
  scene.title += print(", %.4g s to %.4g s", first, last);
  const auto stand = [&](const std::string& name) {
    const auto found = std::find_if(sim.entities.begin(), sim.entities.end(), [&](const Entity& e) { return e.name == name; });
    if (found == sim.entities.end() || !drawn.insert(name).second) return;
    const int index = static_cast<int>(found - sim.entities.begin());
    FlownPath path{name, {}, {}, false};
    constexpr int kParts = 200;  // of one that a carrier moves
    for (int i = 0; i <= kParts; ++i) {
      const double t = first + (last - first) * i / kParts;
      path.time_s.push_back(t), path.position_m.push_back(poseOf(sim, index, t).position);
    }
    scene.paths.push_back(std::move(path));
  };
  for (const Encounter& e : encounters) stand(e.target);
  for (const Camera& c : sim.cameras)
    if (c.mount.lookAtEntity >= 0) stand(sim.entities[static_cast<std::size_t>(c.mount.lookAtEntity)].name);

  const Encounter* nearest = nullptr;
  for (const Encounter& e : encounters) {
    if (e.time_s < first || e.time_s > last) continue;
    if (e.kind == "flight") scene.meetings.push_back({e.body, e.target, e.time_s, e.distance_m, e.at, e.targetAt});
    const bool isBetter = !nearest || (e.kind == "flight" && nearest->kind != "flight") || (e.kind == nearest->kind && e.distance_m < nearest->distance_m);
    if (isBetter) nearest = &e;
  }
  const double at_s = nearest ? nearest->time_s : last;
  for (const Camera& c : sim.cameras) {
    const auto pose = history.cameraPoseAt(c.name, at_s);
    if (!pose) continue;
    FlownSight sight{c.name, at_s, pose->position, pose->orientation * glm::dvec3(1, 0, 0), 0.0};
    std::optional<glm::dvec3> target;
    if (c.mount.looksAtPoint) target = c.mount.lookAtPoint;
    if (c.mount.lookAtEntity >= 0) target = poseOf(sim, c.mount.lookAtEntity, at_s).position;
    if (target) sight.length_m = glm::distance(*target, sight.from);
    scene.sights.push_back(sight);
  }
  return scene;
}

}  // namespace pitviper
