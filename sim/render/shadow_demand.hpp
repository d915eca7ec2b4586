#pragma once
// How many subpixels of a view may ask what shades them: where they are few, rays cost less than a map.
#include "sim/model/simulation.hpp"
#include "sim/model/view.hpp"

namespace pitviper {

/// Subpixels that a caster's shadow from a light covers at most, about: of the ball around it where it and what it shades come nearest to the eye. The sun is
/// the light after the last lamp. No more than the view has.
double shadowedSubpixels(const Simulation& simulation, const WorldState& state, const View& view, std::size_t caster, std::size_t light);

}  // namespace pitviper
