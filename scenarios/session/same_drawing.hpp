#pragma once
// Two readings of one scenario that a picture can be drawn of by the same plan, programs and tables: they differ in what a world holds alone.
#include "sim/model/simulation.hpp"
#include "sim/parameters/value.hpp"
#include "sim/world/world.hpp"

namespace pitviper {

/// Whether `other` differs from `drawn` in places, turnings, temperatures and light levels over time, and a camera's place, focal length and exposure alone.
bool differInWorldAlone(const Simulation& drawn, const Simulation& other, std::size_t camera);
/// A tree with what a world holds as it is in another: two whose wordsOf() are then the same differ in no other key. What a fingerprint of a plan does not
/// hold, such as how a film is read out, is found here.
Value withWorldOf(const Value& tree, const Value& world);

/// A world of `other`, told to what draws `drawn`: the camera is where and as `other` has it.
WorldState worldFor(const Camera& other, WorldState state);

}  // namespace pitviper
