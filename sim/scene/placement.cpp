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

}  // namespace pitviper
