#include "materials/fields/puffs.hpp"

#include <algorithm>
#include <cmath>

#include "materials/fields/puff_physics.hpp"

namespace pitviper {
namespace {

/// Temperatures within this part of each other count as their mean: what they send at 3 um and 500 K is then true to (c2/(lambda T))^2 kAlike^2/24 = 1e-4.
constexpr double kAlike = 0.005;

glm::dvec3 chordOf(const Puff& p, const glm::dvec3& origin, const glm::dvec3& direction) {
  const double squash = p.radius_m / p.length_m() - 1.0;
  return physics::puffChord(physics::puffScaled(origin - p.centre, p.axis, squash, p.radius_m), physics::puffScaled(direction, p.axis, squash, p.radius_m));
}

double densityOf(const Puff& p) { return kPuffNorm / (p.radius_m * p.radius_m * p.length_m()); }

double reachOf(const Puff& p) { return std::max(p.radius_m, p.length_m()); }

/// Whether a line passes within a puff's bounding sphere.
bool passes(const Puff& p, const glm::dvec3& origin, const glm::dvec3& direction) {
  const glm::dvec3 to = p.centre - origin;
  const double along = glm::dot(to, direction), reach = reachOf(p);
  return glm::dot(to, to) - along * along < reach * reach;
}

/// Where steps along a line end: finer near the first puff, the youngest and smallest of a trail. As its shader has it.
class PuffCuts {
 public:
  PuffCuts(const Puff& head, const FieldLine& line, double enter_m, double leave_m) : enter_m_(enter_m), leave_m_(leave_m) {
    const glm::dvec3 to = head.centre - line.origin;
    const double nearest = glm::dot(to, line.direction);
    scale_ = {nearest, 1.0 / std::sqrt(std::max(glm::dot(to, to) - nearest * nearest, 0.0) + head.radius_m * head.radius_m)};
    ends_ = {physics::cutSigma(enter_m, scale_), physics::cutSigma(leave_m, scale_)};
  }
  double at(double part) const {
    if (part <= 0.0) return enter_m_;
    if (part >= 1.0) return leave_m_;
    return std::clamp(physics::cutPlace(ends_.x + (ends_.y - ends_.x) * part, scale_), enter_m_, leave_m_);
  }

 private:
  double enter_m_, leave_m_;
  glm::dvec2 scale_{0.0}, ends_{0.0};
};

}  // namespace

double puffColumn(const Puff& p, const glm::dvec3& origin, const glm::dvec3& direction, double from_m, double to_m) {
  return densityOf(p) * physics::puffColumn(chordOf(p, origin, direction), from_m, to_m);
}

void shadeTowards(const glm::dvec3& toSun, std::vector<Puff>& puffs) {
  for (Puff& p : puffs) {
    p.sunAmount = 0.0;
    for (const Puff& other : puffs)
      if (passes(other, p.centre, toSun)) p.sunAmount += other.amount[0] * puffColumn(other, p.centre, toSun, 0.0, physics::kFar);
  }
}

PuffsState::PuffsState(std::vector<Puff> puffs) : puffs_(std::move(puffs)) {
  origin = puffs_.front().centre;
  low = glm::dvec3(physics::kFar);
  high = -low;
  auto numbers = std::make_shared<FieldTexels>();
  finest_m = physics::kFar;
  for (const Puff& p : puffs_) {
    const glm::dvec3 centre = p.centre - origin;
    const double reach = reachOf(p);
    // Half of it across: its profile falls to a half within 0.42 of it.
    elements.push_back({centre, reach, static_cast<int>(numbers->texel.size()), 0.5 * std::min(p.radius_m, p.length_m()),
                        static_cast<int>(elements.size() * kFieldKinds / puffs_.size()), 0.5 * p.length_m() * p.axis});
    // An ellipsoid's box: along each axis e, sqrt(R^2 + (L^2 - R^2) (axis.e)^2).
    const double own = p.radius_m * p.radius_m, drawn = p.length_m() * p.length_m() - own;
    const glm::dvec3 half = glm::sqrt(glm::dvec3(own) + drawn * p.axis * p.axis);
    low = glm::min(low, centre - half);
    high = glm::max(high, centre + half);
    finest_m = std::min(finest_m, elements.back().finest_m);
    const double density = densityOf(p);
    numbers->texel.emplace_back(glm::vec3(centre), static_cast<float>(p.radius_m));
    numbers->texel.emplace_back(glm::vec3(p.axis), static_cast<float>(p.radius_m / p.length_m() - 1.0));
    numbers->texel.emplace_back(glm::dvec4(p.amount[0], p.amount[1], p.amount[2], p.amount[3]) * density);
    numbers->texel.emplace_back(glm::dvec4(p.temperature_K, p.gain, p.sun, p.sunAmount));
  }
  texels = std::move(numbers);
}

void PuffsState::along(const FieldLine& line, int steps, std::vector<FieldStep>& out) const {
  out.clear();
  struct Met {
    const Puff* puff;
    glm::dvec3 chord;
  };
  std::vector<Met> met;
  double enter = physics::kFar, leave = -physics::kFar;
  for (const Puff& p : puffs_) {
    if (!passes(p, line.origin, line.direction)) continue;
    const glm::dvec3 chord = chordOf(p, line.origin, line.direction);
    const double from = std::max(chord.x - chord.y, line.nearest_m), to = std::min(chord.x + chord.y, line.farthest_m);
    if (!(chord.y > 0.0 && to > from)) continue;
    met.push_back({&p, chord});
    enter = std::min(enter, from);
    leave = std::max(leave, to);
  }
  if (met.empty() || steps < 1) return;
  const int count = static_cast<int>(std::clamp(std::ceil((leave - enter) / (0.25 * finest_m)), 1.0, static_cast<double>(steps)));
  const PuffCuts cuts(puffs_.front(), line, enter, leave);
  // What a stretch holds is even, but at temperatures that send very differently: those alike to kAlike are one step, all of them on the same stretch.
  struct Kind {
    long of = 0;
    double weight = 0.0, heat = 0.0, gained = 0.0, lit = 0.0, shade = 0.0;
    std::array<double, kMostGases> amount{};
  };
  std::vector<Kind> kinds;
  for (int k = 0; k < count; ++k) {
    const double enter_m = cuts.at(static_cast<double>(k) / count), leave_m = cuts.at((k + 1.0) / count);
    kinds.clear();
    for (const Met& m : met) {
      const Puff& p = *m.puff;
      const double column = densityOf(p) * physics::puffColumn(m.chord, enter_m, leave_m);
      if (!(column > 0.0)) continue;
      const long of = std::lround(std::log(p.temperature_K) / kAlike);
      auto kind = std::find_if(kinds.begin(), kinds.end(), [of](const Kind& other) { return other.of == of; });
      if (kind == kinds.end()) kind = kinds.insert(kinds.end(), Kind{.of = of});
      double own = 0.0;
      for (std::size_t g = 0; g < kMostPuffGases; ++g) {
        kind->amount[g] += column * p.amount[g];
        own += column * p.amount[g];
      }
      kind->weight += own;
      kind->heat += own * p.temperature_K;
      kind->gained += own * p.gain;
      kind->lit += own * p.sun;
      kind->shade += own * p.sunAmount;
    }
    for (const Kind& of : kinds)
      if (of.weight > 0.0)
        out.push_back({enter_m, leave_m, of.amount, of.heat / of.weight, 0.0, of.gained / of.weight, of.lit / of.weight, of.shade / of.weight});
  }
}

}  // namespace pitviper
