#pragma once
// Light within a cloud of drops, scattered many times, as numbers of each node that no wavelength is in: made once for a direction of the sun.
// sim/radiometry/glsl/cloud.glsl turns them into what a place sends at a wavelength.
//
// Law: discrete ordinates, 24 directions (level symmetric S4, equal weights), of the delta-scaled cloud (asymmetry 0.85, f = g^2), extinction that of 0.55 um;
//   steps along a direction with sources linear between nodes, sources to the first moment; x = sweep(scatter x) + b by BiCGSTAB. Sunlight enters by
//   exp(-c tau) and is scattered first; sky and ground shine evenly, from above and from below.
// Source: Chandrasekhar 1960 (the equation); Carlson and Lathrop 1968 (S_N); Kunasz and Auer 1988, J. Quant. Spectrosc. Radiat. Transfer 39, 67 (short
//   characteristics); van der Vorst 1992 (BiCGSTAB); Joseph, Wiscombe, Weinman 1976 (delta scaling).
// Valid: held against a Monte Carlo in six clouds and three layers at five albedos, picture means within 2 to 4 % of it (tests/physics/test_cumulus.cpp); a
// cell
//   should hold a depth of 0.5 at most on the lit side. Of one cloud alone: no other stands beside it.
#include "materials/fields/density_grid.hpp"

namespace pitviper {

/// Texels of each node, x fastest: extinction at 0.55 um [1/m], optical depth to the sun, share of the light of an even sky (the rest is the ground's), how
/// that falls with absorption | mean intensity of scattered sunlight for an irradiance of 1 and a scaled albedo of 1 at four albedos [1/sr] | how the ground's
/// light falls, gradient of the second of these [1/(sr m)].
constexpr int kCloudTexels = 3;
/// `toSun`: unit, in the grid's axes; `lit`: there is a sun; `before`: at each node, the optical depth of what else stands before it (empty: nothing). On all
/// threads; the same on any number of them.
std::vector<glm::vec4> cloudNumbers(const DensityGrid& extinction, const glm::dvec3& toSun, bool lit, const std::vector<float>& before = {});

}  // namespace pitviper
