#pragma once
// Where everything is at a time: what the scenario says of it, and what commands have changed.
#include <cmath>
#include <functional>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// The world over simulation time [s], whoever changes it.
using StateAt = std::function<WorldState(double time_s)>;

/// As the scenario has it, its own commands carried out.
WorldState advance(const Simulation& simulation, double time_s);

/// Of an entity as its scenario moves it, whatever commands say: pose in the local frame, velocity [m/s] of its origin there, what its carrier's flight and
/// turning add included.
Pose poseOf(const Simulation& simulation, int entity, double time_s);
glm::dvec3 velocityOf(const Simulation& simulation, int entity, double time_s);
/// The same as commands have it.
Pose poseOf(const Simulation& simulation, const Courses& courses, int entity, double time_s);
glm::dvec3 velocityOf(const Simulation& simulation, const Courses& courses, int entity, double time_s);
/// Where a plan has to look too: as advance(), and what commands may eject burns, unless the scenario's have ejected it. `look`: of several, each finds it at
/// another age.
WorldState withEjected(const Simulation& simulation, double time_s, int look);
/// Before and after which it is not there, for its own sake or its carriers'; infinite where nothing says so.
Lifetime lifetimeOf(const Simulation& simulation, int entity);

/// A world that takes further commands while it runs; what it keeps does not grow with their number. The simulation must outlive it.
class World {
 public:
  explicit World(const Simulation& simulation) : simulation_(simulation) {}
  /// From the beginning of a tick (frame number) on. Commands of one tick hold in the order in which they came, after the scenario's own.
  /// Throws std::invalid_argument where a later tick has had one: what was drawn stays.
  void apply(const Command& command, int tick);
  /// Of the last command's tick, or later. Earlier, as within an exposure that began before: what commands have set since holds there too.
  WorldState at(double time_s) const;

 private:
  const Simulation& simulation_;
  Courses courses_;
  std::size_t next_ = 0;  ///< of the scenario's commands, those before it are in courses_
  double since_s_ = -INFINITY;
};

/// A camera at a time.
struct CameraState {
  Pose pose;  ///< local frame; body axes: x is the line of sight, y left, z up
  Pinhole pinhole;
  ChannelValues exposures_s, gains;  ///< the second: factors of detectors'
};
CameraState cameraAt(const Camera& camera, const WorldState& state);
/// The longest exposure of any of its channels: how long a frame takes.
double longestExposure_s(const Camera& camera, const ChannelValues& exposures_s);

/// What a camera's follower is told of a time.
FollowerTick followerTick(const Camera& camera, const WorldState& state, int frame);
/// With a camera where its follower says.
WorldState pointed(WorldState state, const Camera& camera, const Pose& pose);
/// A command to a camera's follower; its number is given here.
void addPointing(Courses& courses, const std::string& camera, Pointing pointing);

}  // namespace pitviper
