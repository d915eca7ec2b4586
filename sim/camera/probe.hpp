#pragma once
// Irradiance on a plane at a point: the whole hemisphere in five wide views, summed by projected solid angle, and the point lights
// and the sun that reach it.
#include "sim/camera/visible_lights.hpp"
#include "sim/render/geometry/gpu_scene.hpp"

namespace pitviper {

/// A probe's plan and programs, which it keeps from one reading to the next.
class ProbeMeter {
 public:
  /// Simulation, probe and library must outlive it. `plan`: planFor() the probe. Needs a current GlContext.
  ProbeMeter(const Simulation& simulation, const Probe& probe, Plan plan, const ShaderLibrary& library, const std::shared_ptr<const GpuScene>& scene);
  ProbeMeter(const ProbeMeter&) = delete;
  ProbeMeter& operator=(const ProbeMeter&) = delete;
  /// One value per output, in the output's unit. Surfaces are sampled by 5 x resolution^2 rays on a turned grid (no edge of a scene
  /// runs along it); the sky between them likewise.
  std::vector<double> read(const WorldState& state);

 private:
  void addSurroundings(const WorldState& state, std::vector<double>& sums);
  void addLights(const WorldState& state, std::vector<double>& sums) const;
  void addSun(const WorldState& state, std::vector<double>& sums) const;
  const Simulation& simulation_;
  const Probe& probe_;
  glm::dvec3 normal_;
  Plan plan_;
  std::unique_ptr<LineDrawer> drawer_;
  WaysToLights ways_;
  std::vector<char> all_;   ///< flags of all entities
  std::vector<int> lines_;  ///< across each small body
};

}  // namespace pitviper
