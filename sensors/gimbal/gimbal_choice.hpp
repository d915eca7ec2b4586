#pragma once
// A camera's gimbal as a scenario asks for it, and the record of poses that takes its place.
#include <memory>

#include "sensors/gimbal/follow_loop.hpp"
#include "sim/model/simulation.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

/// `gimbal` and the maps in it, in the order of the key reference.
const ParameterTable& gimbalTable();
std::vector<ParameterTable> gimbalTables();

/// From what a user wrote. The camera has its film, mount, outputs and window; the simulation its times, bodies and lights. `target`: where the user says what
/// it looks at. Errors: UserError, also for a gimbal that cannot see its target at the start.
FollowerChoice readGimbal(const Value& value, const Simulation& simulation, const Camera& camera, const Location& target);
/// The same typed. `output`: of the camera, whose pictures Centroid looks at.
FollowerChoice gimbalChoice(const FollowOptions& options, std::optional<std::size_t> output, const Camera& camera, const Location& where);
/// A record in place of what points a camera, with the field of its gimbal if it has one.
FollowerChoice replayChoice(std::shared_ptr<const PoseRecord> record, const Camera& camera);

/// As the loop of a gimbal takes it.
FollowTick followTick(const FollowerTick& tick);

}  // namespace pitviper
