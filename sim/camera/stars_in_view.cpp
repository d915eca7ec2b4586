#include "sim/camera/stars_in_view.hpp"

#include "sim/radiometry/physics.hpp"

namespace pitviper {

void addStarsInView(Subpixels& image, const WaysToLights& ways, const Simulation& sim, const Plan& plan, const WorldState& state,
                    const std::vector<char>& present) {
  const View& v = image.view();
  const glm::dvec3 up = sim.frame.up(v.position);
  const double height_m = sim.frame.height(v.position);
  const bool isAbove = plan.terms.air && sim.air->top_m() < physics::kFar;
  for (const SkyStar& star : sim.stars) {
    const glm::dvec3 p = glm::transpose(v.localFromCamera) * star.direction;
    if (!(-p.z > 1e-3)) continue;
    const glm::dvec2 at = filmPosition(v, p);
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < v.width && at.y < v.height)) continue;
    const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
    const std::size_t subpixel = image.index(x, y);
    if (v.wanted && !(*v.wanted)[subpixel]) continue;
    const double sine = glm::dot(star.direction, up);
    if (sim.ground && physics::groundRange(height_m, sine, sim.frame.earthRadius_m()) < physics::kFar) continue;
    const auto way = ways.from(state, present, v.position, star.direction, physics::kFar, v.near_m / -p.z);
    if (way.empty()) continue;
    const AirAmounts air = isAbove ? sim.air->amounts({height_m, sine, sim.frame.earthRadius_m()}, physics::kFar) : AirAmounts{};
    std::vector<double> sums(image.slotCount(), 0.0);
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
      const SpectralNode& n = plan.nodes[i];
      const double seen = way[i] * n.mean(star.irradiance) * (isAbove ? sim.air->transmittance(n.air, air) : 1.0);
      for (std::size_t s = 0; s < sums.size(); ++s) sums[s] += plan.weight[s][i] * seen;
    }
    for (std::size_t s = 0; s < sums.size(); ++s) {
      if (image.keepsPoints()) image.addPoint(at, subpixel, s, sums[s] * -p.z);
      else image.add(s, subpixel, sums[s] * -p.z / image.projectedSolidAngle_sr(x, y));
    }
  }
}

}  // namespace pitviper
