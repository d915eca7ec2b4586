#pragma once
// How finely bodies are looked at by zoomed views of their own.
#include <vector>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// So many lines or some more, of few sizes, for bodies of one size are drawn together and pictures are kept by size: 16, 24, 32, 48 ...
int evenSize(double lines);

/// Lines across each entity's bounding sphere when it is small: `most`, or fewer where an accuracy is asked for and the body is even (convex, one
/// material and temperature, no textures, no reflection that depends on angles; opaque, or of gas): as many as the area of its outline takes to be known, on
/// average, to a quarter of it. The same for the reference that a camera is held against: audits don't see it. Law: an area A of outline P on a grid of spacing
/// h is off by sqrt(0.0724 P h^3) / A (1 sigma; Source: Gundersen and Jensen 1987, J. Microscopy 147, 229, after Matheron); of a convex mesh of surface S in a
/// sphere of diameter D, A = S / 4 on average over directions (Cauchy) and P = pi D at most.
std::vector<int> zoomedLines(const Simulation& simulation, int most, double accuracy);

/// Areas of each entity as seen along its axes [m2], what lies behind more of it counted too. Along another direction d it is about |(d_x A_x, d_y A_y, d_z
/// A_z)|, exactly so for ellipsoids.
std::vector<glm::dvec3> facingAreas(const Simulation& simulation);
/// Part of a zoomed view's lines that see the body in it, so many square metres large.
double zoomedFill(double area_m2, double radius_m);

}  // namespace pitviper
