#pragma once
// By about what factor a picture would be brighter if sunlight that the air scatters more than once were in it: it is left out.
#include <optional>
#include <string>
#include <vector>

#include "sim/model/ray_hits.hpp"
#include "sim/model/two_stream.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {

struct ScatteredAgain {
  std::string channel;
  double factor = 1.0;  ///< radiance with it over radiance without, the middle one of the lines of sight looked at
  double depth = 0.0;   ///< optical depth of scattering on such a line and on to the sun
};

class ScatteringCheck {
 public:
  /// Both must outlive it. `plan`: of the camera's outputs. Nothing to say without layered air in sunlight.
  ScatteringCheck(const Simulation& simulation, const Camera& camera, const Plan& plan);
  /// Channels that the sun lights and in which the depth is above 0.2, at a time: five lines of sight over the film, two-stream fluxes of the whole
  /// column of air over the ground that lies below the camera. Shadows are not asked for. Within a factor of 2 or so (tests/physics/test_scattered_again.cpp).
  std::vector<ScatteredAgain> at(const WorldState& state) const;
  bool looks() const { return !channels_.empty(); }  ///< false: at() has nothing to say, whenever
  static constexpr double kMatters = 0.2;

 private:
  struct Column {
    std::vector<double> depth;  ///< above each height, all extinction
    double albedo = 0.0, asymmetry = 0.0;
  };
  struct Channel {
    std::string name;
    std::vector<SpectralNode> nodes;
    std::vector<double> weight;
    std::vector<Column> columns;
  };
  double heightAt(int entry) const;
  struct Line;
  /// Of a line at a node: radiance as drawn, what light scattered again would add, optical depth of what scatters.
  struct Parts {
    double own, more, scattering;
  };
  double depthAbove(const Column& column, double height_m) const;
  std::vector<Line> linesOver(const WorldState& state, std::optional<Hit>& below) const;
  double ambientOn(const glm::dvec3& normal, double height_m, double wavelength_um) const;
  Parts partsOf(const Channel& channel, std::size_t node, const Line& line, const std::optional<Hit>& below, const AirAmounts& slant) const;

  const Simulation& sim_;
  const Camera& camera_;
  const Plan& plan_;
  std::vector<Channel> channels_;
};

}  // namespace pitviper
