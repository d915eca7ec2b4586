#pragma once
// The key `stabilised` of a camera: which angles of its carrier do not reach it.
#include "sim/model/simulation.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

/// `stabilised` of a camera whose mount has its carrier and what it looks at; the simulation has its bodies. Errors: UserError.
Steadied readSteadied(const Record& camera, const Mount& mount, const Simulation& simulation);

}  // namespace pitviper
