#pragma once
// By about what factor a picture would be brighter if sunlight that the air scatters more than once were in it: it is left out.
#include <optional>
#include <string>
#include <vector>

#include "sim/plan/photon_walk.hpp"
#include "sim/plan/plan.hpp"
#include "sim/radiance/node_air.hpp"
#include "sim/world/ray_hits.hpp"

namespace pitviper {

struct ScatteredAgain {
  std::string channel;
  double factor = 1.0;             ///< radiance with it over radiance without, the middle one of the lines of sight looked at
  double least = 1.0, most = 1.0;  ///< of all of them
  double error = 0.0;              ///< of the middle one by chance, relative, one sigma; 0.5 and more under a sun so low that level air is no more than a guess
};

class ScatteringCheck {
 public:
  /// Both must outlive it. `plan`: of the camera's outputs. Nothing to say without layered air in sunlight.
  ScatteringCheck(const Simulation& simulation, const Camera& camera, const Plan& plan);
  /// Channels that the sun lights and in which some line of sight would be brighter by more than the plan's accuracy, or 1 % where it has none, at a time:
  /// five lines over the film, photons followed back from them through level air over the ground that lies below the camera (the earth under a small roof).
  /// Shadows of bodies are not asked for; haze scatters as the picture's own does (tests/physics/test_scattered_again.cpp).
  std::vector<ScatteredAgain> at(const WorldState& state) const;
  bool looks() const { return !channels_.empty(); }  ///< false: at() has nothing to say, whenever

 private:
  struct Column {
    std::vector<double> all, molecules, haze;  ///< optical depth above each height: of everything, and of what scatters
    double asymmetry = 0.0;
  };
  struct Channel {
    std::string name;
    std::vector<SpectralNode> nodes;
    std::vector<double> weight;
    std::vector<Column> columns;
    std::optional<NodeAir> air;  ///< of these nodes
  };
  struct Line;
  struct SunAt;
  /// Of a line at a node: radiance as drawn, what light scattered again would add, and its variance.
  struct Parts {
    double own, more, variance;
  };
  double heightAt(int entry) const;
  double aboveAt(const std::vector<double>& column, double height_m) const;
  std::vector<Line> linesOver(const WorldState& state, std::optional<Hit>& below) const;
  WalkAir airOver(const Channel& channel, std::size_t node, const std::optional<Hit>& below, const std::vector<SunAt>& sun, const glm::dvec3& toSun) const;
  double ambientOn(const glm::dvec3& normal, double height_m, double wavelength_um) const;
  Parts partsOf(const Channel& channel, std::size_t node, const Line& line, const NodeRadiance& seen, const PhotonWalk& walk) const;

  const Simulation& sim_;
  const Camera& camera_;
  const Plan& plan_;
  std::vector<Channel> channels_;
};

}  // namespace pitviper
