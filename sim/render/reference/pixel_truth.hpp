#pragma once
// What is true of the surface that a place of a film sees, in double precision: as sim/render/assembly/glsl/truth_layers.glsl has it.
#include "sim/radiance/radiance.hpp"
#include "sim/world/view.hpp"

namespace pitviper {

/// Truth of a pixel, in the order of the layers; all 0 where nothing is seen.
struct TruthPixel {
  float area_m2 = 0, solidAngleFromLight_sr = 0, solidAngleOfAperture_sr = 0, range_m = 0;
  float normal[3] = {0, 0, 0};  ///< east, north, up
  float temperature_K = 0;
  float entity = 0, part = 0, cosView = 0;  ///< from 1 on, 0 none
};

/// Of what a line of a view [from its eye] meets: a body or the ground; all 0 where it meets neither. `textureAccuracy`: as of a plan; `lamps`: whether
/// surfaces know of lamps, of which truth is told of the first.
TruthPixel truthOf(const Simulation& simulation, const WorldState& state, const View& view, const LineOfSight& line, double apertureArea_m2,
                   double textureAccuracy, bool lamps);
/// The same of a place of the view [pixels from the lower left]. `present`: one flag per entity.
TruthPixel truthSeen(const Simulation& simulation, const WorldState& state, const View& view, const glm::dvec2& place, const std::vector<char>& present,
                     double apertureArea_m2, double textureAccuracy, bool lamps);

}  // namespace pitviper
