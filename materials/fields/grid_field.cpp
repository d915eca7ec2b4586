#include "materials/fields/grid_field.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim/model/simulation.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace physics {

/// The shader's own text, in double.
class GridLine {
 public:
  explicit GridLine(const std::vector<glm::vec4>& texels) : texels_(texels) {}
  Vec3 q_{0.0}, d_{1.0, 0.0, 0.0};
  Real perT_ = 1.0, enter_ = 0.0, leave_ = 0.0;
  Vec4 amountLow_{0.0}, amountHigh_{0.0};
  Real weight_ = 0.0, heat_ = 0.0;
  Vec4 fieldTexel(int i) const { return Vec4(texels_[static_cast<std::size_t>(i)]); }
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"  // the contract of field shaders
#include "materials/fields/glsl/grid.field.glsl"
#pragma GCC diagnostic pop

 private:
  const std::vector<glm::vec4>& texels_;
};
}  // namespace physics

namespace {

class GridState : public FieldState {
 public:
  explicit GridState(const GridFlow& g) {
    low = g.first;
    high = g.first + glm::dvec3(g.nodes - 1) * g.spacing;
    finest_m = std::min({g.spacing.x, g.spacing.y, g.spacing.z});
    elements.push_back({0.5 * (low + high), 0.5 * glm::length(high - low) * 1.001, 0, finest_m, 0, {}});
    const std::size_t gases = g.perMetre.size(), wide = gases > 3 ? 2 : 1, count = g.temperature_K.size();
    auto all = std::make_shared<FieldTexels>();
    auto& t = all->texel;
    t.reserve(6 + count * wide);
    t.emplace_back(low, g.nodes.x);
    t.emplace_back(1.0 / g.spacing, g.nodes.y);
    t.emplace_back(high, g.nodes.z);
    // What weighs temperatures: each gas by the most of it that there is.
    std::array<float, 8> weight{};
    for (std::size_t i = 0; i < gases; ++i) {
      const float most = *std::max_element(g.perMetre[i].begin(), g.perMetre[i].end());
      weight[i] = most > 0.0f ? 1.0f / most : 0.0f;
    }
    t.emplace_back(weight[0], weight[1], weight[2], 0.0f);
    t.emplace_back(weight[3], weight[4], weight[5], weight[6]);
    t.emplace_back(static_cast<float>(wide), 0.0f, 0.0f, 0.0f);
    const auto gas = [&](std::size_t i, std::size_t node) { return i < gases ? g.perMetre[i][node] : 0.0f; };
    for (std::size_t n = 0; n < count; ++n) {
      t.emplace_back(g.temperature_K[n], gas(0, n), gas(1, n), gas(2, n));
      if (wide > 1) t.emplace_back(gas(3, n), gas(4, n), gas(5, n), gas(6, n));
    }
    texels = all;
  }

  void along(const FieldLine& line, int steps, std::vector<FieldStep>& out) const override {
    out.clear();
    physics::GridLine at(texels->texel);
    at.q_ = (line.origin - origin) * localFromField;  // transposed: into field axes
    at.d_ = line.direction * localFromField;
    const glm::dvec2 chord = at.fieldChord(0);
    at.enter_ = std::max(chord.x, line.nearest_m);
    at.leave_ = std::min(chord.y, line.farthest_m);
    if (!(chord.y > chord.x) || !(at.leave_ > at.enter_) || steps < 1) return;
    double from = at.enter_;
    for (int i = 0; i < steps; ++i) {
      const double to = at.fieldCut((i + 1.0) / steps);
      at.amountLow_ = at.amountHigh_ = glm::dvec4(0.0);
      at.weight_ = at.heat_ = 0.0;
      at.fieldAdd(0, from, to);
      if (at.weight_ > 0.0) {
        FieldStep step;
        step.enter_m = from;
        step.leave_m = to;
        for (int g = 0; g < 4; ++g) {
          step.amount[static_cast<std::size_t>(g)] = at.amountLow_[g];
          step.amount[static_cast<std::size_t>(g + 4)] = at.amountHigh_[g];
        }
        step.temperature_K = at.heat_ / at.weight_;
        out.push_back(step);
      }
      from = to;
    }
  }
};

}  // namespace

GridSource::GridSource(GridSetup setup) : setup_(std::move(setup)) {
  if (!setup_.flow) throw std::invalid_argument("grid: none");
  const GridFlow& g = *setup_.flow;
  if (std::min({g.nodes.x, g.nodes.y, g.nodes.z}) < 2) throw std::invalid_argument("grid: two nodes along each axis at least");
  if (!(std::min({g.spacing.x, g.spacing.y, g.spacing.z}) > 0.0)) throw std::invalid_argument("grid: spacings above 0");
  const std::size_t count = static_cast<std::size_t>(g.nodes.x) * static_cast<std::size_t>(g.nodes.y) * static_cast<std::size_t>(g.nodes.z);
  if (g.perMetre.empty() || g.perMetre.size() > kMostGridGases) throw std::invalid_argument("grid: one to seven gases");
  if (g.temperature_K.size() != count || std::any_of(g.perMetre.begin(), g.perMetre.end(), [&](const auto& v) { return v.size() != count; }))
    throw std::invalid_argument("grid: as many values as nodes");
  const auto [low, high] = std::minmax_element(g.temperature_K.begin(), g.temperature_K.end());
  range_K_ = {*low, *high};
  state_ = std::make_shared<GridState>(g);
}

std::shared_ptr<const FieldState> GridSource::at(const FieldWorld& world) const {
  if (!setup_.life.has(world.time_s)) return nullptr;
  const Pose pose = setup_.entity >= 0 ? world.poseAt(setup_.entity, world.time_s) : Pose{};
  const glm::dmat3 turned = glm::mat3_cast(pose.orientation);
  auto placed = std::make_shared<GridState>(static_cast<const GridState&>(*state_));
  placed->origin = pose.position + turned * setup_.position;
  placed->localFromField = turned * setup_.bodyFromGrid;
  return placed;
}

void GridSource::addTo(Fingerprint& f) const {
  const GridFlow& g = *setup_.flow;
  f.add("grid").add(setup_.entity).add(setup_.position).add(setup_.bodyFromGrid[0]).add(setup_.bodyFromGrid[1]).add(setup_.bodyFromGrid[2]);
  f.add(setup_.life.begin_s).add(setup_.life.end_s).add(glm::dvec3(g.nodes)).add(g.first).add(g.spacing).all(g.temperature_K);
  for (const auto& gas : g.perMetre) f.all(gas);
}

}  // namespace pitviper
