#pragma once
#include "sim/model/simulation.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

/// `stabilised` of a camera whose mount has its carrier and what it looks at; the simulation has its bodies. Errors: UserError.
Steadied readSteadied(const Record& camera, const Mount& mount, const Simulation& simulation);

}  // namespace pitviper
