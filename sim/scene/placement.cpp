#include "sim/scene/placement.hpp"

#include "sim/radiometry/constants.hpp"

namespace pitviper {

std::vector<Parameter> positionParameters() {
  return {within(vector3("position", "m", "east, north, up from the origin (or in the carrier's body axes: forward, left, up)"), -kFarthest_m, kFarthest_m),
          map("geodetic", "position as latitude, longitude, height instead")};
}

std::vector<Parameter> attitudeParameters(double mostTurn_rad) {
  return {within(number("heading", "rad",
                        "of the x axis, clockwise from north (on a carrier: from its forward axis); 90 deg unless given: x east, y north. An attitude, not a "
                        "turn: 360 deg is 0 deg"),
                 -mostTurn_rad, mostTurn_rad),
          within(number("pitch", "rad", "nose up; 0 unless given"), -kPi, kPi),
          within(number("roll", "rad", "right wing down; 0 unless given"), -mostTurn_rad, mostTurn_rad)};
}

std::vector<Parameter> geodeticParameters() {
  return {required(within(number("latitude", "rad", "geodetic, WGS 84"), -kPi / 2, kPi / 2)),
          required(within(number("longitude", "rad", "east positive"), -kPi, 2 * kPi)),
          withDefault(within(number("height", "m", "above the ellipsoid"), -20000, 1e8), "0 m")};
}

std::optional<glm::dvec3> readPosition(const Record& r, const LocalFrame& frame) {
  if (r.given("position") && r.given("geodetic")) throw UserError(r.where("geodetic"), "a position and a geodetic position", "one of the two", "remove one");
  if (r.given("position")) return r.vector("position");
  if (!r.given("geodetic")) return std::nullopt;
  static const ParameterTable table{"geodetic", "", geodeticParameters()};
  const Record g(r.value("geodetic"), table);
  return frame.toLocal({g.number("latitude"), g.number("longitude"), g.number("height")});
}

std::optional<Attitude> readAttitude(const Record& r, bool attached) {
  if (!r.given("heading") && !r.given("pitch") && !r.given("roll")) return std::nullopt;
  Attitude a;
  a.heading_rad = r.given("heading") ? r.number("heading") : attached ? 0.0 : 0.5 * kPi;  // as a body that is not turned
  if (attached) a.heading_rad += 0.5 * kPi;                                               // clockwise from the carrier's forward axis instead of north
  if (r.given("pitch")) a.pitch_rad = r.number("pitch");
  if (r.given("roll")) a.roll_rad = r.number("roll");
  return a;
}

std::vector<Parameter> commandedPoseParameters() {
  std::vector<Parameter> keys = positionParameters();
  keys.push_back(within(vector3("velocity", "m/s", "goes on from the position; at rest unless given"), -1e6, 1e6));
  for (auto& p : attitudeParameters(kMostTurn_rad)) {
    if (p.key != "heading") p.description += ", with a heading";
    keys.push_back(std::move(p));
  }
  return keys;
}

CommandedPose readCommandedPose(const Record& r, const LocalFrame& frame, bool attached) {
  if (attached && r.given("geodetic"))
    throw UserError(r.where("geodetic"), "a geodetic position of something attached to a body", "'position' in the body's axes", "use 'position'");
  for (const char* key : {"pitch", "roll"})
    if (r.given(key) && !r.given("heading"))
      throw UserError(r.where(key), std::string("a ") + key + " but no heading", "an attitude as a whole: what is not given of it is 0", "add 'heading:'");
  CommandedPose pose{readPosition(r, frame), readAttitude(r, attached)};
  if (r.given("velocity")) {
    if (!pose.position) throw UserError(r.where("velocity"), "a velocity without a position to go on from", "both", "add 'position:', or remove 'velocity'");
    pose.velocity = r.vector("velocity");
  }
  return pose;
}

}  // namespace pitviper
