#pragma once
// A flow that a solver worked out, on a regular grid, as a field: temperature and amounts of gases, trilinear between nodes.
#include <memory>
#include <vector>

#include "sim/model/field.hpp"
#include "sim/scene/lifetime.hpp"

namespace pitviper {

/// Gases at most: two texels a node.
constexpr std::size_t kMostGridGases = 7;

struct GridFlow {
  glm::ivec3 nodes{2};
  glm::dvec3 first{0.0}, spacing{1.0};       ///< place of the first node and what lies between [m], in the grid's own axes
  std::vector<float> temperature_K;          ///< x fastest, then y, then z
  std::vector<std::vector<float>> perMetre;  ///< of each gas: its amount per metre (partial pressure [atm], volume fraction, kg/m3)
};

struct GridSetup {
  std::shared_ptr<const GridFlow> flow;
  int entity = -1;               ///< whose axes it lies in; -1: the local frame
  glm::dvec3 position{0.0};      ///< of the grid's origin in these
  glm::dmat3 bodyFromGrid{1.0};  ///< a rotation
  Lifetime life;
};

/// It is there, or it isn't, from one frame to the next. Sampled at least once a node along a line, up to 32 times a step.
class GridSource : public FieldSource {
 public:
  /// std::invalid_argument: sizes that differ, fewer than two nodes along an axis, more than kMostGridGases, spacings not above 0; values are not looked at.
  explicit GridSource(GridSetup setup);
  std::shared_ptr<const FieldState> at(const FieldWorld& world) const override;
  std::string shader() const override { return "materials/fields/glsl/grid.field.glsl"; }
  void addTo(Fingerprint& fingerprint) const override;
  glm::dvec2 temperatures_K() const override { return range_K_; }
  std::string target() const override { return "plume"; }
  /// In its own axes, at origin 0.
  std::shared_ptr<const FieldState> state() const { return state_; }

 private:
  GridSetup setup_;
  glm::dvec2 range_K_{0.0};
  std::shared_ptr<const FieldState> state_;
};

}  // namespace pitviper
