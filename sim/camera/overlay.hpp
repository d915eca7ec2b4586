#pragma once
// Where anything transparent may show in a picture: that part alone needs the buffered pass, and is laid over the direct pass' picture of the rest.
#include <optional>
#include <vector>

#include "sim/model/simulation.hpp"
#include "sim/render/scene_pass.hpp"

namespace pitviper {

/// Two parts of a view [subpixels: corner, size]: what is drawn, and what of it counts. Edges between pixels are told by neighbours, so that more is drawn.
struct Overlay {
  glm::ivec4 drawn{0}, counts{0};
  bool isEmpty() const { return counts.z <= 0; }
};

/// Around fields and those transparent bodies of `bodies` (one flag per entity) that may show in a camera's own view. Nothing where it is so much of the view
/// that drawing all of it costs no more.
std::optional<Overlay> overlayIn(const Simulation& simulation, const WorldState& state, const View& view, const std::vector<char>& bodies);
/// The view of that part alone.
View overlayView(const View& view, const Overlay& overlay);
/// Lays what was drawn of it over the picture of the whole view.
void lay(const RawImage& part, const View& view, const Overlay& overlay, RawImage& picture);

}  // namespace pitviper
