#pragma once
// Positions and attitudes as users write them: in scenarios, in commands.
#include <optional>

#include "sim/parameters/table.hpp"
#include "sim/scene/geodesy.hpp"
#include "sim/scene/motion.hpp"

namespace pitviper {

/// `position` and `geodetic`.
std::vector<Parameter> positionParameters();
/// `heading`, `pitch` and `roll`; the first and the last within so many radians.
std::vector<Parameter> attitudeParameters(double mostTurn_rad);
/// Of an attitude given once, whole turns don't matter: so many are taken for a slip of a program that counts on, not of a unit [rad].
constexpr double kMostTurn_rad = 200 * 3.14159265358979324;
/// More than twice the way to the moon [m].
constexpr double kFarthest_m = 1e9;
/// 32 years: a double still tells 0.1 us apart there.
constexpr double kLongestTime_s = 1e9;
/// Latitude, longitude, height.
std::vector<Parameter> geodeticParameters();

/// In the local frame, or as given in a carrier's. Errors: UserError where both keys are given.
std::optional<glm::dvec3> readPosition(const Record& record, const LocalFrame& frame);
/// A position and an attitude of a command: as above, but no geodetic position in a carrier's axes, and an attitude that is whole. Errors: UserError.
struct CommandedPose {
  std::optional<glm::dvec3> position;
  std::optional<Attitude> attitude;
  std::optional<glm::dvec3> velocity{};  ///< with which it goes on from the position; none: it stays there
};
CommandedPose readCommandedPose(const Record& record, const LocalFrame& frame, bool attached);
/// `position`, `geodetic`, `velocity`, `heading`, `pitch` and `roll` of it.
std::vector<Parameter> commandedPoseParameters();

/// `attached`: the heading is clockwise from the carrier's forward axis instead of north. What is not given is as of a body that is not turned.
std::optional<Attitude> readAttitude(const Record& record, bool attached);

}  // namespace pitviper
