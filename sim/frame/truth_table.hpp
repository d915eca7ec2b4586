#pragma once
// What is true of a camera's targets at a time, and what its light is made of, pixel by pixel: by the radiance equation in double precision, at the wavelengths
// of a plan, along lines of sight of its own. Nothing is drawn for it.
#include <memory>

#include "sim/frame/frame.hpp"
#include "sim/frame/lost_wavelengths.hpp"
#include "sim/plan/plan.hpp"
#include "sim/radiance/node_sum.hpp"
#include "sim/world/world.hpp"

namespace pitviper {

class TruthMeter {
 public:
  /// `camera`: the film's, which asks for targets or terms. Both must outlive it.
  TruthMeter(const Simulation& simulation, const Camera& camera);

  /// A row for each body but terrain and the camera's carrier, for each plume and flare that is there, and for each lamp that can be seen. Intensities of a
  /// body: over lines of a square grid over its bounding sphere, 128 across at 1 %, six times as many where what they meet changes; worked out where they bend,
  /// linear between within a twenty-fifth of the accuracy. `own`: emission and reflection of its surfaces or its medium, through all that lies before it;
  /// `total`: all light along lines that meet it before anything opaque; `contrast`: that less what these lines would have without it. Each times range
  /// squared, with what the plan's wavelengths lose of them (LostWavelengths). A camera within a body's sphere gets NaN. Of a plume or flare: over lines as the
  /// reference has them through a pixel, times the range of its nozzles or flame squared; its box holds all lines along which it sends a hundredth of what it
  /// does along its brightest; `visible` is the share of what it sends that reaches the film past what is opaque.
  std::vector<TargetRow> targets(const WorldState& state, const StateAt& stateAt = {}) const;

  /// Layers `truth.terms.<channel>.<part>` [W/(m2 sr)] at pixels' middles, before the sensor's stages: emission, ambient, sun, lamp.<name> (light of that lamp
  /// that surfaces reflect), air_emission, scattered_sun, background, media, lamps_in_view; those that the scene can have. Their sum is the channel's radiance.
  std::vector<FrameLayer> terms(const WorldState& state) const;

 private:
  /// Where something is at a time, a little before and a little after.
  struct Moment {
    const WorldState& state;
    glm::dvec3 place;
  };
  TargetRow placed(const std::string& name, const char* kind, const Moment& now, const Moment& before, const Moment& after) const;
  void addBody(TargetRow& row, int entity, const WorldState& state) const;
  void addField(TargetRow& row, std::size_t field, const WorldState& state) const;
  void addLamp(TargetRow& row, std::size_t light, const WorldState& state) const;
  /// Of kernel integrals times range squared, in the order of Plan::slotCount. `faces_sr`: of each channel, the solid angle over which it would be as bright as
  /// its brightest pixel; empty: that of the body.
  void addChannels(TargetRow& row, const std::vector<double>& own, const std::vector<double>& total, const std::vector<double>& contrast, double body_sr,
                   const WorldState& state, const std::vector<double>& faces_sr = {}) const;

  const Simulation& simulation_;
  const Camera& camera_;
  std::vector<ChannelOutput> measured_;
  std::vector<std::size_t> radianceOf_;  ///< of each channel, an output of it
  double asked_;                         ///< accuracy
  double lines_;                         ///< across a body
  std::vector<char> present_;
  Plan plan_;
  std::shared_ptr<const NodeSpectra> spectra_;
  LostWavelengths lost_;
};

}  // namespace pitviper
