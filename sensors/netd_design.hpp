#pragma once
// Read noise from the NETD that a detector is designed for.
#include "sim/model/simulation.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

/// Where `netd` is given sets law.netd and law.sigmaTvh, so that the camera's NETD (figures.hpp) is that: sigma = dN/dT sqrt(netd^2 - n^2), n the NETD of all
/// other noise from frame to frame. The camera has its film, exposure, outputs and the stages before its detector, the law everything else. Errors: UserError
/// where other noise alone is more.
void designNoise(const Record& detector, const Camera& camera, DetectorLaw& law);

}  // namespace pitviper
