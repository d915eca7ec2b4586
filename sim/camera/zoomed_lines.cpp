#include "sim/camera/zoomed_lines.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>

#include "sim/plan/budget.hpp"
#include "sim/world/shadow_casters.hpp"

namespace pitviper {
namespace {

/// A convex body that is the same all over, and opaque and reflects the same into all directions, or of gas, which ends as a solid does or thins out
/// towards its outline: what is small on it is its outline.
bool isEven(const Simulation& sim, const Entity& e) {
  const SelfShadow self = selfShadow(e, true);
  if (sim.mediumOf(e)) return self == SelfShadow::Never || self == SelfShadow::Inside;
  if (sim.isTransparent(e) || (self != SelfShadow::Never && self != SelfShadow::Inside)) return false;
  const auto plain = [](const auto& modifiers) { return std::all_of(modifiers.begin(), modifiers.end(), [](int texture) { return texture < 0; }); };
  for (const Surface& s : e.surfaces) {
    const Material& m = sim.materialOf(s);
    const Surface& first = e.surfaces.front();
    if (s.temperatureTexture >= 0 || s.temperature_K != first.temperature_K || s.temperature != first.temperature || s.material != first.material) return false;
    if (m.states || m.hemisphericalVaries() || !plain(m.modifiers) || (m.given && m.given->modifier >= 0)) return false;
    for (const auto& r : m.reflections)
      if (!r->lobe().file.empty() || r->axes()[0].angle != Angle::None) return false;
  }
  return true;
}

/// A number of each mesh that is asked for, found once.
template <class Value>
class OfMeshes {
 public:
  /// `add`: a triangle's vector area [m2] to the value.
  template <class Add>
  Value of(const Entity& e, const Add& add) {
    const auto [known, fresh] = known_.try_emplace(e.mesh.get(), Value(0.0));
    if (fresh)
      for (const auto& t : e.mesh->triangles) {
        const glm::dvec3 a = e.mesh->positions[t.x];
        add(known->second, 0.5 * glm::cross(glm::dvec3(e.mesh->positions[t.y]) - a, glm::dvec3(e.mesh->positions[t.z]) - a));
      }
    return known->second;
  }

 private:
  std::map<const Mesh*, Value> known_;
};

}  // namespace

int evenSize(double lines) {
  constexpr int kFewest = 16, kMost = 4096;
  int size = kFewest;
  while (size < lines && size < kMost) size += std::has_single_bit(static_cast<unsigned>(size)) ? size / 2 : size / 3;
  return size;
}

std::vector<int> zoomedLines(const Simulation& sim, int most, double accuracy) {
  std::vector<int> lines;
  OfMeshes<double> surfaces_m2;
  for (const Entity& e : sim.entities) {
    lines.push_back(most);
    if (accuracy <= 0.0 || !isEven(sim, e)) continue;
    const double across = 2.0 * static_cast<double>(e.boundingRadius_m),
                 area = 0.25 * surfaces_m2.of(e, [](double&sum, const glm::dvec3&own) { sum += glm::length(own); }), outline = glm::pi<double>() * across;
    // h = across / lines in the law, solved for them.
    const double needed = area > 0.0 ? across * std::cbrt(outline * 0.0724 / std::pow(budget::kOutlines.of(accuracy) * area, 2.0)) : INFINITY;
    lines.back() = std::min(evenSize(needed), most);
  }
  return lines;
}

std::vector<glm::dvec3> facingAreas(const Simulation& sim) {
  std::vector<glm::dvec3> all;
  OfMeshes<glm::dvec3> areas_m2;
  // Of the two sides of a closed mesh each is seen from one side.
  for (const Entity& e : sim.entities) all.push_back(areas_m2.of(e, [](glm::dvec3& sum, const glm::dvec3& own) { sum += 0.5 * glm::abs(own); }));
  return all;
}

double zoomedFill(double area_m2, double radius_m) {
  const double side_m = 2.04 * radius_m;  // as zoomedView()
  return side_m > 0.0 ? std::min(area_m2 / (side_m * side_m), 1.0) : 1.0;
}

}  // namespace pitviper
