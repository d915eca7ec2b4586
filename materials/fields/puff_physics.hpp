#pragma once
// materials/fields/glsl/puff.glsl in double.
#include "sim/radiometry/physics.hpp"

namespace pitviper::physics {
#define PHYSICS inline
#include "materials/fields/glsl/cuts.glsl"
#include "materials/fields/glsl/puff.glsl"
#undef PHYSICS
}  // namespace pitviper::physics
