#pragma once
// How temperature changes within the steps that a line through a field is cut into: where they are thick the near end of a step is what shows of it. With it a
// sum over steps misses a smooth line by their fourth power, about, else by their square.
#include <span>

#include "sim/model/field.hpp"

namespace pitviper {

/// 1 / T [1/K] at the far end of a step less that at its near end, by the 1 / T in the middle of it and of those that touch it, nearer and farther, and their
/// lengths: twice the smaller of both changes to where two meet; 0 where it is the hottest or coldest of the three. As driftOf() of
/// sim/render/media/glsl/volume_field.frag.glsl.
double driftOf(double nearer, double nearerLength, double own, double length, double farther, double fartherLength);

/// Sets FieldStep::drift_perK of steps along a line, nearest first.
void setDrifts(std::span<FieldStep> steps);

}  // namespace pitviper
