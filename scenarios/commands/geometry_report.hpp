#pragma once
// What the subpixels of a camera make of edges and of small bright parts: said by `check` before anything is drawn.
#include <string>

#include "sim/plan/plan.hpp"

namespace pitviper {

/// Part of the contrast on its two sides that an edge leaves a pixel, or a mean of pixels x pixels, off by (1 sigma over places and directions) with
/// samples x samples subpixels a pixel. Law: an area on a grid of spacing h with an outline P is off by sqrt(0.0724 P h^3). Source: Gundersen and Jensen 1987.
double edgeError(int samples, int pixels);

/// What edges are off by and, of an accuracy asked for (0: none), the fewest samples that leave means of 4 x 4 pixels within it, or the nearest that any do.
std::string edgeText(const Camera& camera, double accuracy);

/// Lines on a camera: edgeText(). Where bright parts
/// have no views of their own (no accuracy is asked for), which of them `samples` leaves a body's intensity off by more than a hundredth, in the first,
/// middle or last frame.
std::string geometryText(const Simulation& simulation, const Camera& camera, const Plan& plan);

}  // namespace pitviper
