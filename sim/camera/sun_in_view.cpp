#include "sim/camera/sun_in_view.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Directions on the rim by which its place on the film is bounded; lines across a subpixel that it fills in part, and wholly.
constexpr int kRim = 32, kAcross = 8, kAcrossWhole = 2;
/// Spread over fewer subpixels than these across it is told by directions of its own, so many.
constexpr double kFew = 16.0, kGoldenAngle = 2.399963229728653;
constexpr int kOverDisc = 1024;
/// Elevations over which air towards it is told, from its lower to its upper rim.
constexpr int kElevations = 17;

/// What it sends at rising sines of elevation over its height, per slot [kernel unit x W/(m2 sr)], and per node.
class DiscRadiance {
 public:
  DiscRadiance(const Simulation& sim, const Plan& plan, const glm::dvec3& place) : plan_(plan) {
    const glm::dvec3 up = sim.frame.up(place);
    const double elevation = std::asin(std::clamp(glm::dot(sim.sun->toSun, up), -1.0, 1.0)), radius = physics::sunRadius();
    const bool isAbove = plan.terms.air && sim.air->top_m() < physics::kFar;
    for (int k = 0; k < kElevations; ++k) {
      const double sine = std::sin(elevation + radius * (2.0 * k / (kElevations - 1) - 1.0));
      sine_.push_back(sine);
      const AirAmounts air = isAbove ? sim.air->amounts({sim.frame.height(place), sine, sim.frame.earthRadius_m()}, physics::kFar) : AirAmounts{};
      for (const SpectralNode& n : plan.nodes)
        node_.push_back(n.mean(sim.sun->irradiance) / (kPi * radius * radius) * (isAbove ? sim.air->transmittance(n.air, air) : 1.0));
    }
  }
  void add(double sine, const std::vector<double>& way, double share, Subpixels& image, size_t subpixel) const {
    const double at = std::clamp((sine - sine_.front()) / std::max(sine_.back() - sine_.front(), 1e-12), 0.0, 1.0) * (kElevations - 1);
    const auto k = std::min(static_cast<size_t>(at), sine_.size() - 2), nodes = plan_.nodes.size();
    const double f = at - static_cast<double>(k);
    for (size_t s = 0; s < image.slotCount(); ++s) {
      double sum = 0.0;
      for (size_t i = 0; i < nodes; ++i) sum += plan_.weight[s][i] * way[i] * ((1.0 - f) * node_[k * nodes + i] + f * node_[(k + 1) * nodes + i]);
      image.add(s, subpixel, share * sum);
    }
  }

 private:
  const Plan& plan_;
  std::vector<double> sine_, node_;
};

}  // namespace

void addSunInView(Subpixels& image, const WaysToLights& ways, const Simulation& sim, const Plan& plan, const WorldState& state,
                  const std::vector<char>& present) {
  if (!sim.sun) return;
  const View& v = image.view();
  const glm::dvec3 toSun = sim.sun->toSun, up = sim.frame.up(v.position);
  const double radius = physics::sunRadius();
  const glm::dvec3 side = glm::normalize(glm::cross(std::abs(toSun.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0), toSun)),
                   other = glm::cross(toSun, side);
  glm::dvec2 low(INFINITY), high(-INFINITY);
  for (int k = 0; k < kRim; ++k) {
    const double a = 2.0 * kPi * k / kRim;
    const glm::dvec3 p = glm::transpose(v.localFromCamera) * (toSun + 1.02 * radius * (std::cos(a) * side + std::sin(a) * other));
    if (!(-p.z > 1e-3)) return;
    const glm::dvec2 at = filmPosition(v, p);
    low = glm::min(low, at), high = glm::max(high, at);
  }
  low = glm::max(low, glm::dvec2(0.0)), high = glm::min(high, glm::dvec2(v.width, v.height));
  if (!(high.x > low.x && high.y > low.y)) return;
  const DiscRadiance disc(sim, plan, v.position);
  const double height_m = sim.frame.height(v.position), inside = std::cos(radius);
  const auto axisOf = [&](const glm::dvec3& d) { return -(glm::transpose(v.localFromCamera) * d).z; };
  const auto isUp = [&](const glm::dvec3& d) {
    return !sim.ground || !(physics::groundRange(height_m, glm::dot(d, up), sim.frame.earthRadius_m()) < physics::kFar);
  };
  /// Directions of it in a subpixel that the earth leaves free, and what share of the subpixel is of it if all of them are.
  struct Piece {
    int lines = 0;
    glm::dvec3 sum{0.0};
  };
  const auto add = [&](size_t subpixel, const Piece& part, double eachFills) {
    const glm::dvec3 middle = glm::normalize(part.sum);
    const auto way = ways.from(state, present, v.position, middle, physics::kFar, v.near_m / axisOf(middle));
    if (!way.empty()) disc.add(glm::dot(middle, up), way, part.lines * eachFills, image, subpixel);
  };
  if (high.x - low.x < kFew || high.y - low.y < kFew) {
    // All over the disc evenly: its flux is whole however wide pixels are.
    std::map<std::pair<int, int>, Piece> parts;
    for (int k = 0; k < kOverDisc; ++k) {
      const double r = radius * std::sqrt((k + 0.5) / kOverDisc), a = kGoldenAngle * k;
      const glm::dvec3 d = glm::normalize(toSun + r * (std::cos(a) * side + std::sin(a) * other));
      const glm::dvec2 at = filmPosition(v, glm::transpose(v.localFromCamera) * d);
      if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < v.width && at.y < v.height) || !isUp(d)) continue;
      Piece& part = parts[{static_cast<int>(at.x), static_cast<int>(at.y)}];
      ++part.lines, part.sum += d;
    }
    for (const auto& [at, part] : parts)
      if (const size_t subpixel = image.index(at.first, at.second); !v.wanted || (*v.wanted)[subpixel])
        add(subpixel, part, kPi * radius * radius * axisOf(toSun) / (kOverDisc * image.projectedSolidAngle_sr(at.first, at.second)));
    return;
  }
  const auto towards = [&](double x, double y) { return glm::normalize(v.localFromCamera * v.ray(x, y)); };
  const auto isIn = [&](const glm::dvec3& d) { return glm::dot(d, toSun) >= inside; };
  for (int y = static_cast<int>(low.y); y < static_cast<int>(std::ceil(high.y)); ++y)
    for (int x = static_cast<int>(low.x); x < static_cast<int>(std::ceil(high.x)); ++x) {
      const size_t at = image.index(x, y);
      if (v.wanted && !(*v.wanted)[at]) continue;
      const bool isWhole = isIn(towards(x, y)) && isIn(towards(x + 1.0, y)) && isIn(towards(x, y + 1.0)) && isIn(towards(x + 1.0, y + 1.0));
      const int across = isWhole ? kAcrossWhole : kAcross;
      Piece part;
      for (int j = 0; j < across; ++j)
        for (int i = 0; i < across; ++i) {
          const glm::dvec3 d = towards(x + (i + 0.5) / across, y + (j + 0.5) / across);
          if (isIn(d) && isUp(d)) ++part.lines, part.sum += d;
        }
      if (part.lines > 0) add(at, part, 1.0 / (across * across));
    }
}

}  // namespace pitviper
