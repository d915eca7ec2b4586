#pragma once
// What a sweep measures of a frame.
#include <vector>

#include "scenarios/sweep/sweep.hpp"
#include "sim/frame/frame.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// Errors: UserError at a measure that no frame of this scenario has: a camera, layer, target or region that is not there, truth that its camera does not ask
/// for. Measures of Python are not looked at.
void refuseUnknownMeasures(const Simulation& simulation, const std::vector<Measure>& measures);

/// The camera whose frame a measure is of, by its place.
std::size_t cameraOf(const Simulation& simulation, const Measure& measure);

struct MeasuredValue {
  double value = 0.0;  ///< NaN: this frame has none
  std::string unit;
};
/// Not of Python. Pixels that are not finite are left out of statistics.
MeasuredValue measured(const Frame& frame, const Measure& measure);

}  // namespace pitviper
