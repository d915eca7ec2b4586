#pragma once
// Irradiance on a plane at a point: the whole hemisphere in five wide views, summed by projected solid angle, and the point lights
// and the sun that reach it.
#include "sim/render/scene_pass.hpp"

namespace pitviper {

/// One value per output, in the output's unit. Surfaces are sampled by 5 x resolution^2 rays on a turned grid (no edge of a scene
/// runs along it); the sky between them likewise.
std::vector<double> measureProbe(const Simulation& simulation, const Probe& probe, const ShaderLibrary& library, const std::shared_ptr<const GpuScene>& scene,
                                 const WorldState& state);

}  // namespace pitviper
