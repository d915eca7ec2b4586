#pragma once
// The shared .glsl bodies of sim/radiometry compiled as C++ double. The same text is compiled as GLSL float: a comparison
// of the two measures rounding only; closed forms in tests/ show that the formulas are right.
#include <cmath>
#include <glm/glm.hpp>

namespace pitviper::physics {
using Real = double;
using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec4 = glm::dvec4;
using glm::cross;
using glm::dot;
using std::abs;
using std::exp;
using std::floor;
using std::ldexp;
using std::log;
using std::sqrt;
inline Real max(Real a, Real b) { return a > b ? a : b; }
inline Real min(Real a, Real b) { return a < b ? a : b; }
/// Largest x for which exp(-x) is a normal number.
constexpr Real kExpLimit = 708.0;
/// Stands for an infinite distance [m].
constexpr Real kFar = 1e30;

#define PHYSICS inline
#include "sim/radiometry/glsl/arc_tangent.glsl"
#include "sim/radiometry/glsl/chord.glsl"
#include "sim/radiometry/glsl/cloud.glsl"
#include "sim/radiometry/glsl/exponential.glsl"
#include "sim/radiometry/glsl/footprint.glsl"
#include "sim/radiometry/glsl/geometry.glsl"
#include "sim/radiometry/glsl/ground.glsl"
#include "sim/radiometry/glsl/segment.glsl"
#include "sim/radiometry/glsl/shell.glsl"
// After what it uses.
#include "sim/radiometry/glsl/medium.glsl"
#include "sim/radiometry/glsl/planck.glsl"
#include "sim/radiometry/glsl/sun_disc.glsl"
#undef PHYSICS
}  // namespace pitviper::physics
