#pragma once
// Flights of a scenario: bodies that are thrown or that fly at others, worked out once while the scenario is read.
#include "scenarios/reader/motions.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// What is asked of a flight: `motion` of a body, a light or a camera, and where it starts.
struct FlightAsked {
  std::string name;  ///< of what flies, for messages
  Record owner;      ///< the body's own map: position, heading, ...
  const Value* motion;
  bool attitude;     ///< whether it has `heading`, `pitch` and `roll`
  int carrier = -1;  ///< entity that it starts from
  int target = -1;   ///< entity that it flies at
  bool coriolis = true;
};

/// `target` of a missile's motion, or null. The motion has been checked by its table afterwards.
const Value* flightTarget(const Value& motion);

/// Integrates it. Entities that it depends on must have their motions. Errors: UserError.
FlightRecord flyAsked(const Simulation& simulation, const FlightAsked& asked, const MotionEnds& ends);

/// Skin temperature by recovery over the scenario's times, of an entity whose motion and whose carriers' are known: `{recovery: turbulent, ...}`. Errors:
/// UserError.
TimeCourse readRecovery(const Simulation& simulation, int entity, const Value& value);
/// Whether a temperature asks for it.
bool isRecovery(const Value& temperature);
namespace tables {
const ParameterTable& recovery();
}

}  // namespace pitviper
