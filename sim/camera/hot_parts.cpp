#include "sim/camera/hot_parts.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>

#include "sim/plan/budget.hpp"

namespace pitviper {
namespace {

/// Diagonals of a subpixel around a part: one, and some.
constexpr double kRoom = 1.06;

double meanOf(const Texture& t) {
  return std::accumulate(t.texels.begin(), t.texels.end(), 0.0, [](double sum, float v) { return sum + static_cast<double>(v); }) /
         static_cast<double>(std::max<std::size_t>(t.texels.size(), 1));
}

}  // namespace

HotParts::HotParts(const Simulation& sim, const Plan& plan, double accuracy) : simulation_(sim), plan_(plan), accuracy_(accuracy) {
  for (const Entity& e : sim.entities) {
    std::vector<Part>& parts = parts_.emplace_back();
    if (accuracy <= 0.0 || e.surfaces.size() < 2 || sim.mediumOf(e)) continue;
    for (std::size_t s = 0; s < e.surfaces.size(); ++s) {
      const Surface& surface = e.surfaces[s];
      const MeshPart& own = e.mesh->parts[surface.meshPart];
      Part p;
      p.surface = static_cast<int>(s);
      glm::dvec3 low(INFINITY), high(-INFINITY);
      for (std::uint32_t t = own.firstTriangle; t < own.firstTriangle + own.triangleCount; ++t) {
        const glm::uvec3 i = e.mesh->triangles[t];
        const glm::dvec3 a = e.mesh->positions[i.x], b = e.mesh->positions[i.y], c = e.mesh->positions[i.z];
        p.area_m2 += 0.125 * glm::length(glm::cross(b - a, c - a));
        for (const glm::dvec3& corner : {a, b, c}) low = glm::min(low, corner), high = glm::max(high, corner);
      }
      if (!(p.area_m2 > 0.0)) continue;
      p.centre = 0.5 * (low + high);
      p.radius_m = 0.5 * glm::length(high - low);
      if (surface.temperatureTexture >= 0) p.textured_K = meanOf(sim.textures[static_cast<std::size_t>(surface.temperatureTexture)]);
      parts.push_back(p);
    }
  }
}

const std::vector<double>& HotParts::brightness(double temperature_K) {
  const auto [known, fresh] = brightness_.try_emplace(temperature_K);
  if (!fresh) return known->second;
  if (brightness_.size() > 4096) brightness_ = {{temperature_K, {}}};
  std::vector<double>& own = brightness_[temperature_K];
  own.assign(static_cast<std::size_t>(plan_.slotCount), 0.0);
  for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
    const double sent = plan_.nodes[i].planck(temperature_K);
    for (std::size_t s = 0; s < own.size(); ++s) own[s] += plan_.weight[s][i] * sent;
  }
  return own;
}

/// How much of a body's intensity a part is that the rest of it would not be in its place, at most over the channels.
double HotParts::weightOf(const std::vector<Part>& parts, std::size_t which, const std::vector<double>& temperatures_K) {
  const auto slots = static_cast<std::size_t>(plan_.slotCount);
  std::vector<double> all(slots, 0.0), own(slots, 0.0);
  double area = 0.0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto& b = brightness(parts[p].textured_K > 0.0 ? parts[p].textured_K : temperatures_K[static_cast<std::size_t>(parts[p].surface)]);
    for (std::size_t s = 0; s < slots; ++s) {
      all[s] += parts[p].area_m2 * b[s];
      if (p == which) own[s] = parts[p].area_m2 * b[s];
    }
    area += parts[p].area_m2;
  }
  double weight = 0.0;
  const double part = parts[which].area_m2, rest = area - part;
  for (std::size_t s = 0; s < slots; ++s)
    if (all[s] > 0.0) weight = std::max(weight, std::abs(own[s] - (rest > 0.0 ? (all[s] - own[s]) / rest * part : 0.0)) / all[s]);
  return weight;
}

std::vector<Ball> HotParts::inView(const WorldState& state, const View& v, double limit, const std::vector<char>& small, const std::vector<char>& present) {
  std::vector<Ball> balls;
  for (std::size_t e = 0; e < parts_.size(); ++e) {
    if (!present[e] || !state.isThere(e) || small[e] || parts_[e].empty()) continue;
    const Pose& pose = state.entities[e];
    for (std::size_t p = 0; p < parts_[e].size(); ++p) {
      const Part& part = parts_[e][p];
      Ball ball{static_cast<int>(e), part.surface, pose.position + pose.orientation * part.centre, part.radius_m};
      const double extent = extentOf(ball, v);
      if (!(extent < limit) || !mayShow(v, ball.centre, ball.radius_m)) continue;
      const double h = 2.0 * part.radius_m / extent, outline = 2.0 * glm::pi<double>() * part.radius_m;
      const double weight = weightOf(parts_[e], p, state.temperatures_K[e]);
      if (std::min(std::sqrt(0.0724 * outline * h * h * h) / part.area_m2, 1.0) * weight <= budget::kBrightParts.of(accuracy_)) continue;
      // Subpixels that see anything of it lie wholly in its view: what the picture has there is replaced as a whole.
      ball.radius_m += kRoom * h * std::hypot(v.tanPerPixelX, v.tanPerPixelY) / std::min(v.tanPerPixelX, v.tanPerPixelY);
      ball.lines_per_m = 1.0 / std::min(std::cbrt(std::pow(budget::kBrightParts.of(accuracy_) * part.area_m2 / weight, 2.0) / (0.0724 * outline)), h);
      // One view for parts that lie in each other, unless it would be too large.
      for (auto other = balls.begin(); other != balls.end();) {
        const glm::dvec3 line = other->centre - ball.centre;
        const double apart = glm::length(line), around = std::max(0.5 * (apart + ball.radius_m + other->radius_m), std::max(ball.radius_m, other->radius_m));
        Ball both{ball.entity, ball.surface, ball.centre, around, std::max(ball.lines_per_m, other->lines_per_m)};
        if (apart > 0.0) both.centre += line / apart * std::clamp(around - ball.radius_m, 0.0, apart);
        if (other->entity != ball.entity || apart >= ball.radius_m + other->radius_m || !(extentOf(both, v) < limit)) {
          ++other;
          continue;
        }
        ball = both;
        other = balls.erase(other);
      }
      balls.push_back(ball);
    }
  }
  return balls;
}

}  // namespace pitviper
