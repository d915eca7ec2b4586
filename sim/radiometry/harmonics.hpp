#pragma once
// Real spherical harmonics, orthonormal over the sphere, and what is symmetrical to a plane as a sum of zonal ones.
//
// Law: Y_l0 = K_l0 P_l(z); Y_lm = sqrt(2) K_lm cos(m phi) P_l^m(z), Y_l-m the same with sin; K_lm^2 = (2l + 1)/(4 pi) (l - m)!/(l + m)!, without the sign
// (-1)^m. Source: Ramamoorthi and Hanrahan 2001; Lindsay and Agu 2005, equations (2) and (3).
#include <array>
#include <glm/glm.hpp>
#include <span>

namespace pitviper {

/// Orders up to this are used: 25 coefficients.
constexpr int kMostHarmonicOrder = 4;
constexpr int harmonicCount(int order) { return (order + 1) * (order + 1); }
constexpr int kMostHarmonics = harmonicCount(kMostHarmonicOrder);
using Harmonics = std::array<double, kMostHarmonics>;

/// All up to an order at a unit vector; Y_lm stands at l l + l + m.
void realHarmonics(const glm::dvec3& direction, int order, std::span<double> into);

/// What is even in y, of degree l: sum over k = 0..l of w_k Z_l(a_k) with directions a_k in the plane y = 0, at these angles from z towards x. The first is z
/// itself, so that what is symmetrical about z has a weight for it alone.
constexpr std::array<double, kMostHarmonicOrder + 1> kPlaneTurns = {0.0, 2.0 / 5.0, 4.0 / 5.0, 1.0 / 5.0, 3.0 / 5.0};  ///< of half a turn
constexpr int kPlaneWeights = (kMostHarmonicOrder + 1) * (kMostHarmonicOrder + 2) / 2;
constexpr int planeWeightAt(int l, int k) { return l * (l + 1) / 2 + k; }
/// `even`: coefficients of Y_lm, m = 0..l, at planeWeightAt(l, m); into: weights w_lk at planeWeightAt(l, k), for which
/// sum of even_lm L_lm = sum of w_lk L_l(a_k), L_l(a) = sum over m of L_lm Y_lm(a).
std::array<double, kPlaneWeights> planeWeights(const std::array<double, kPlaneWeights>& even);

}  // namespace pitviper
