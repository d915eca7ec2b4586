#pragma once
// How things move: what stands under `motion`, `ends`, `spin`, `begin` and `end` of a body, a light or a camera.
#include <memory>
#include <optional>

#include "sim/parameters/table.hpp"
#include "sim/scene/flight_record.hpp"
#include "sim/scene/geodesy.hpp"
#include "sim/scene/lifetime.hpp"

namespace pitviper {

namespace tables {
const ParameterTable& ends();
const ParameterTable& spin();
const ParameterTable& wind();
const ParameterTable& motionWaypoints();
const ParameterTable& motionRoute();
const ParameterTable& routePoint();
const ParameterTable& motionCsv();
const ParameterTable& motionBallistic();
const ParameterTable& motionMissile();
}  // namespace tables

/// What lies beyond both ends of a motion.
struct MotionEnds {
  AtEnd before = AtEnd::Hold, after = AtEnd::Hold;
};
/// `ends` of a body: one word, or a map of `before` and `after`. Errors: UserError.
MotionEnds readEnds(const Record& r, const MotionEnds& otherwise);
/// `spin`, if given. Errors: UserError.
std::optional<Spin> readSpin(const Record& r);
/// `begin` and `end`, where there are such keys. Errors: UserError for an end that is not after the begin.
Lifetime readLifetime(const Record& r);
/// Where the air goes [m/s]. Errors: UserError.
glm::dvec3 readWind(const Value& value);

/// The word after `model` of a motion that is a map. Errors: UserError for one that there is not.
std::string motionModelOf(const Value& motion);
/// "ballistic" and "missile": flights, which depend on how others move.
bool isFlight(const std::string& model);

/// A motion along waypoints: a list of them. `attached`: in a carrier's axes. Errors: UserError.
Motion readWaypoints(const Value& list, const LocalFrame& frame, bool attached, bool linear, const MotionEnds& ends);
/// A route flown within limits. Errors: UserError, at the waypoint that asks for too much.
Trajectory readRoute(const Value& motion, const LocalFrame& frame, const MotionEnds& ends);

}  // namespace pitviper
