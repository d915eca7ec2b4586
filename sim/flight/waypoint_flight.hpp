#pragma once
// A target that flies along waypoints: straight legs, turns as arcs within a g limit, banked as a pilot would.
#include <optional>
#include <span>
#include <stdexcept>

#include "sim/scene/geodesy.hpp"
#include "sim/scene/trajectory.hpp"

namespace pitviper {

/// It passes the corner at a waypoint on an arc that touches both legs; first and last are reached.
struct FlightWaypoint {
  glm::dvec3 position{0.0};      ///< local east-north-up [m]
  double speed_m_s = 0.0;        ///< there; constant through the turn, changed evenly along legs. Above 0 where it turns
  std::optional<double> turn_g;  ///< lateral acceleration of this turn, in units of 9.80665 m/s2; absent: the most
};

struct WaypointFlightOptions {
  double begin_s = 0.0;             ///< at the first waypoint
  double mostLateral_g = 5.0;       ///< of turns: radius v^2/a. With weight, a pilot feels sqrt(n^2 + 1) in a level one
  double mostLongitudinal_g = 2.0;  ///< of changes of speed; thrust over weight of fighters is about 1
  /// z of the body along lift: tan(bank) = a/g in a level turn. It never flies inverted: where it pushes over by more than 0.9 g, a tenth of g is left to bank
  /// against.
  bool bank = true;
  double bankTime_s = 1.0;  ///< bank is averaged over this time, so that it rolls in and out evenly, half of it before the turn; 0: at once
  double step_s = 0.02;     ///< between points of the trajectory, at most
  bool followEarth = true;  ///< legs keep or change height above the earth evenly, as great circles; otherwise they are straight in local axes
  AtEnd before = AtEnd::Hold, after = AtEnd::GoOn;
};

/// What a waypoint asks for that is not allowed. `waypoint` counts from 0.
class WaypointRefusal : public std::runtime_error {
 public:
  enum class Reason { FewPoints, NotFinite, SamePlace, NoSpeed, TurnsBack, TurnTooTight, TurnAboveLimit, SpeedChange, TooLong, Option };
  WaypointRefusal(Reason isBecause, std::size_t itsWaypoint, double needed, double allowed, const std::string& text)
      : std::runtime_error(text), reason(isBecause), waypoint(itsWaypoint), needed_g(needed), allowed_g(allowed) {}
  Reason reason;
  std::size_t waypoint;
  double needed_g, allowed_g;  ///< of TurnTooTight, TurnAboveLimit and SpeedChange; else 0
};

/// Turns are arcs of radius R = v^2/a that touch the legs R tan(angle/2) from the corner. Lateral acceleration is v^2/R in a turn, 0 on legs; orientation
/// along the path. Points stand at all joints, on whose two sides acceleration differs; between points the path departs from arcs by under a millimetre
/// (5 g, 20 ms). With followEarth, legs are laid out on the azimuthal map about the scenario's origin on the sphere of LocalFrame, at the mean height of the
/// waypoints: speeds and radii across the view from the origin are in error by d^2/(6 R_earth^2) at distance d (4e-5 at 100 km) and by the difference of
/// height over R_earth (1.6e-4 per km). `frame` is not used otherwise.
/// Errors: WaypointRefusal.
Trajectory flyWaypoints(std::span<const FlightWaypoint> waypoints, const WaypointFlightOptions& options, const LocalFrame& frame);

}  // namespace pitviper
