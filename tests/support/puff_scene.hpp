#pragma once
// Fields made in code and put into scenes, for tests of what carries them.
#include <vector>

#include "materials/fields/puffs.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper::test {

/// A field of these puffs, the same at all times, of one gas with these properties per unit of amount.
void addPuffs(Simulation& simulation, std::vector<Puff> puffs, const Medium& gas);
/// A round puff.
Puff puffAt(const glm::dvec3& centre, double radius_m, double amount, double temperature_K);
/// A grey gas.
Medium greyGas(double absorptionPerAmount);

}  // namespace pitviper::test
