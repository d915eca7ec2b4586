#pragma once
// Bodies of less than a few pixels: each is drawn by a zoomed view of its own, behind whatever hides it, and its radiance over its
// projected area is shared over the pixels it falls into, the background it hides taken away. So a target keeps its intensity at any
// range:  sum over pixels of (L - L_background) w_pix = tau(R) (I - L_background A_projected) / R^2.
#include <functional>
#include <vector>

#include "sim/camera/hot_parts.hpp"
#include "sim/camera/subpixels.hpp"

namespace pitviper {

/// One flag per entity: true where its bounding sphere spans fewer subpixels than the limit and stands in front of the camera.
std::vector<char> findSmallBodies(const Simulation& simulation, const WorldState& state, const View& view, double limit_subpixels);

/// The part of a view (corner, size) in which small bodies and bright parts may show, with their views' corners; of no size where none does.
glm::ivec4 smallBodiesIn(const Simulation& simulation, const WorldState& state, const View& view, const std::vector<char>& small,
                         const std::vector<char>& present, const std::vector<Ball>& parts = {});

/// Truth of what a place of the film sees [subpixels from the lower left].
using TruthAt = std::function<TruthPixel(const WorldState&, const glm::dvec2&)>;

/// Draws every small body that may show and adds it to the image. `present`: all entities that can be seen or hide (small ones too).
/// `lines`: as zoomedLines(). `parts`: of other bodies, to be sampled as finely. `wanted`: one flag per subpixel, or null for all. The image must hold
/// everything but the small bodies. `truthAt`: of pixels that see them, where it is asked for.
void addSmallBodies(Subpixels& image, LineDrawer& drawer, const Simulation& simulation, const WorldState& state, const std::vector<char>& small,
                    const std::vector<char>& present, const std::vector<int>& lines, const std::vector<Ball>& parts = {},
                    const std::vector<char>* wanted = nullptr, const TruthAt& truthAt = {});

}  // namespace pitviper
