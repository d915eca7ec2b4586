#include "sim/camera/stars_in_view.hpp"

#include "sim/radiometry/physics.hpp"

namespace pitviper {

void addStarsInView(Subpixels& image, const WaysToLights& ways, const Simulation& sim, const Plan& plan, const WorldState& state,
                    const std::vector<char>& present) {
  const View& v = image.view();
  const glm::dvec3 up = sim.frame.up(v.position);
  const double height_m = sim.frame.height(v.position);
  const bool isAbove = plan.terms.air && sim.air->top_m() < physics::kFar;
  // Of the wavelengths themselves: what a group says of the air was chosen without stars. Made for the first that is seen.
  std::vector<std::vector<AirNode>> airs;
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
    for (std::size_t i = 0; isAbove && airs.size() < plan.nodes.size(); ++i) {
      auto& own = airs.emplace_back();
      for (const SpectralNode::Member& m : plan.nodes[i].members) own.push_back(sim.air->node(m.wavelength_um));
    }
    std::vector<double> sums(image.slotCount(), 0.0);
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
      const SpectralNode& n = plan.nodes[i];
      double seen = 0.0;
      for (std::size_t m = 0; m < n.members.size(); ++m)
        seen += n.members[m].share * star.irradiance(n.members[m].wavelength_um) * (isAbove ? sim.air->transmittance(airs[i][m], air) : 1.0);
      seen *= way[i];
      for (std::size_t s = 0; s < sums.size(); ++s) sums[s] += plan.weight[s][i] * seen;
    }
    for (std::size_t s = 0; s < sums.size(); ++s) {
      if (image.keepsPoints()) image.addPoint(at, subpixel, s, sums[s] * -p.z);
      else image.add(s, subpixel, sums[s] * -p.z / image.projectedSolidAngle_sr(x, y));
    }
  }
}

}  // namespace pitviper
