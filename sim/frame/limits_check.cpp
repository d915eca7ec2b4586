#include "sim/frame/limits_check.hpp"

#include <cmath>
#include <vector>

#include "sim/parameters/print.hpp"
#include "sim/world/view.hpp"

namespace pitviper {
namespace {

/// Things named one by one; of more their number.
constexpr size_t kMostNamed = 4;

std::string metres(double v) { return std::abs(v) >= 1e3 ? print("%.4g km", 1e-3 * v) : print("%.4g m", v); }
std::string kelvins(double v) { return print("%.4g K", v); }

}  // namespace

std::string outsideLimits(const Simulation& sim, const Camera& camera, const WorldState& state) {
  const Limits& limits = sim.limits;
  std::vector<std::string> found;
  const View view = cameraView(camera, state, camera.samples);
  for (size_t e = 0; e < sim.entities.size() && (limits.farthest_m > 0.0 || limits.hottest_K > 0.0); ++e) {
    const Entity& body = sim.entities[e];
    const Pose& pose = state.entities[e];
    const glm::dvec3 centre = pose.position + pose.orientation * glm::dvec3(body.boundingCentre);
    const auto radius = static_cast<double>(body.boundingRadius_m);
    if (static_cast<int>(e) == camera.mount.carrier || !state.isThere(e) || !mayShow(view, centre, radius)) continue;
    const double range = glm::length(centre - view.position);
    if (limits.farthest_m > 0.0 && range - radius > limits.farthest_m)
      found.push_back(body.name + " at " + metres(range - radius) + ", planned to " + metres(limits.farthest_m));
    if (limits.farthest_m > 0.0 && range + radius < limits.nearest_m)
      found.push_back(body.name + " at " + metres(range + radius) + ", planned from " + metres(limits.nearest_m));
    double coldest = INFINITY, hottest = 0.0;
    for (size_t s = 0; s < body.surfaces.size(); ++s)
      if (const double t = state.temperatures_K[e][s]; body.surfaces[s].temperatureTexture < 0) coldest = std::min(coldest, t), hottest = std::max(hottest, t);
    if (limits.hottest_K > 0.0 && hottest > limits.hottest_K)
      found.push_back(body.name + " at " + kelvins(hottest) + ", planned to " + kelvins(limits.hottest_K));
    if (limits.hottest_K > 0.0 && coldest < limits.coldest_K)
      found.push_back(body.name + " at " + kelvins(coldest) + ", planned from " + kelvins(limits.coldest_K));
  }
  for (size_t l = 0; l < sim.lights.size() && limits.lightLevel > 0.0; ++l)
    if (sim.lights[l].lamp < 0 && state.lightLevels[l] > limits.lightLevel)
      found.push_back("light " + sim.lights[l].name + " at level " + print("%.4g", state.lightLevels[l]) + ", planned to " + print("%.4g", limits.lightLevel));
  std::string text;
  for (size_t k = 0; k < std::min(kMostNamed, found.size()); ++k) text += (k ? "; " : "") + found[k];
  if (found.size() > kMostNamed) text += "; and " + std::to_string(found.size() - kMostNamed) + " more";
  return text;
}

std::string describe(const Limits& limits) {
  std::string text;
  if (limits.farthest_m > 0.0) text = "bodies at " + metres(limits.nearest_m) + " to " + metres(limits.farthest_m);
  if (limits.hottest_K > 0.0) text += (text.empty() ? "bodies at " : ", at ") + kelvins(limits.coldest_K) + " to " + kelvins(limits.hottest_K);
  if (limits.lightLevel > 0.0) text += (text.empty() ? "" : ", ") + ("lights to level " + print("%.4g", limits.lightLevel));
  return text;
}

}  // namespace pitviper
