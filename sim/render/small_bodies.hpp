#pragma once
// Bodies of less than a few pixels: each is drawn by a zoomed view of its own, and its radiance over its projected area is shared over
// the pixels it falls into, the background it hides taken away. So a target keeps its intensity at any range:
//   sum over pixels of (L - L_background) w_pix = tau(R) (I - L_background A_projected) / R^2.
#include <vector>

#include "sim/render/subpixels.hpp"

namespace pitviper {

/// One flag per entity: true where it spans fewer than limit_px pixels and stands in front of the camera.
std::vector<char> findSmallBodies(const Simulation& simulation, const WorldState& state, const View& view, double limit_subpixels);

/// Diameter of an entity's bounding sphere [subpixels of the view]; infinite where it reaches the camera.
double smallBodyExtent(const Simulation& simulation, const WorldState& state, const View& view, int entity);

/// The zoomed view of an entity from the same place: turned so that its bounding sphere fills the picture, and rolled by an angle
/// that no edge of a scene shares, so that silhouettes are sampled evenly (an edge along the pixel grid would be off by up to a
/// whole row).
View zoomedView(const Simulation& simulation, const WorldState& state, const View& view, int entity, int size);

/// Adds what `zoomed` saw of the entity to the image.
void addSmallBody(Subpixels& image, const View& zoomedView, const RawImage& zoomed, const WorldState& state, int entity);

}  // namespace pitviper
