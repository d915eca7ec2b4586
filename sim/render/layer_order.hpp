#pragma once
// Back to front: the order in which transparent triangles and media are blended.
#include <cstdint>
#include <string>
#include <vector>

#include "sim/model/view.hpp"
#include "sim/scene/body_form.hpp"

namespace pitviper {

/// A transparent triangle, or the whole body of a medium, in camera axes [m] (z < 0 in front).
struct LayerPiece {
  std::uint32_t draw = 0;
  std::uint32_t triangle = 0;  ///< in the shared index buffer; unused for a medium
  bool medium = false;
  int group = -1;        ///< of media that are blended together: media_groups.hpp
  int field = -1;        ///< index into Simulation::fields: the piece is that field, a medium; draw and triangle are unused
  glm::dvec3 corner[3];  ///< of a triangle
  /// Of a medium: its box in its own axes, and where these stand.
  glm::dvec3 low{0.0}, high{0.0}, origin{0.0};
  BodyForm form{};  ///< true form within the box
  glm::dmat3 cameraFromBody{1.0};
};

/// What an order is not right about.
struct OrderFaults {
  bool exact = true;  ///< false where there were too many pieces to compare those that overlap: sorted by their middles only
  int crossing = 0;   ///< pairs found to pass through each other; with a medium, on some hundred lines of sight over what they share
  int cyclic = 0;     ///< pieces that overlap in a ring: put in order by their middles
  /// "exact", "exact but for 1 pair that passes through each other and 2 pieces in rings", "by middles": for a frame's metadata.
  std::string describe() const;
  /// Of a picture's views the most.
  void add(const OrderFaults& ofView);
};

struct LayerOrder : OrderFaults {
  std::vector<std::uint32_t> pieces;  ///< indices of those in view, to be blended in this order
  /// Pieces of one level don't overlap in the picture: level k is [levels[k], levels[k + 1]).
  std::vector<std::uint32_t> levels;
};

/// Pieces that overlap in the picture are compared where they overlap (in double precision): right for all pieces that don't pass through
/// each other, whatever their sizes. Of two that do, one is drawn before the other as a whole. A medium counts at the middle of its way on a line
/// of sight that meets both, so that what stands inside it is in front of it or behind it as a whole; a meshed one stands for its box. Two fields that pass
/// through each other are as far as their origins. Equally far: in the order given.
LayerOrder orderLayers(const View& view, const std::vector<LayerPiece>& pieces);

}  // namespace pitviper
