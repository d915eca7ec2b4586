#include "scenarios/reader/motions.hpp"

#include <cmath>

#include "scenarios/reader/tables.hpp"
#include "sim/flight/waypoint_flight.hpp"
#include "sim/parameters/time_course.hpp"
#include "sim/scene/placement.hpp"

namespace pitviper {
namespace {

const std::vector<std::pair<const char*, AtEnd>> kEnds = {{"hold", AtEnd::Hold}, {"go_on", AtEnd::GoOn}, {"loop", AtEnd::Loop}, {"vanish", AtEnd::Vanish}};
const std::vector<std::string> kModels = {"waypoints", "route", "csv", "ballistic", "missile"};
constexpr std::size_t kMostWaypoints = 100000;

Parameter modelKey(const char* name) { return required(choice("model", {name}, "")); }

}  // namespace

namespace tables {

const ParameterTable& ends() {
  static const ParameterTable t{
      "ends",
      "What a motion does before its first point and after its last. hold: stands still there; go_on: keeps velocity and attitude; loop: again and again; "
      "vanish: "
      "is not there, neither seen nor in the way of light.",
      {choice("before", kEnds, "before the first point; as the motion's model has it unless given", &MotionEnds::before),
       choice("after", kEnds, "after the last point; the same", &MotionEnds::after)}};
  return t;
}

const ParameterTable& spin() {
  static const ParameterTable t{
      "spin",
      "Turning about an axis of the body, by any number of turns, on top of the attitude that it has anyway: rotors, rolling missiles, tumbling debris.",
      {required(vector3("axis", "", "in body axes (x forward, y left, z up); turns are right-handed about it, as a right wing goes down about x", &Spin::axis)),
       within(number("rate", "rad/s", "even; from time 0 on, or `from`", &Spin::rate_rad_s), -1e5, 1e5),
       number("from", "s", "of an even rate: the time at which it has turned by nothing", &Spin::from_s),
       course("angle", "rad", "instead of a rate: the angle over time, beyond 360 deg as far as it goes", &Spin::angle_rad)}};
  return t;
}

const ParameterTable& wind() {
  static const ParameterTable t{"wind",
                                "Even air that moves: flights drift with it, smoke too.",
                                {required(within(number("speed", "m/s", "over ground"), 0.0, 200.0)),
                                 required(within(number("direction", "rad", "where it comes from, clockwise from north, as weather reports have it"),
                                                 -6.2831853071795865, 6.2831853071795865))}};
  return t;
}

const ParameterTable& motionWaypoints() {
  static const ParameterTable t{
      "motion: waypoints",
      "Times and places; the attitude follows the path unless a waypoint gives one. A list of waypoints right under `motion` is the same.",
      {modelKey("waypoints"), required(list("points", "waypoints", 1, kMostWaypoints)),
       choice("interpolation", {"smooth", "linear"}, "between waypoints: cubic with continuous velocity, or straight; smooth unless given")}};
  return t;
}

const ParameterTable& motionRoute() {
  static const ParameterTable t{
      "motion: route",
      "Flown along waypoints at a speed: straight legs (great circles over the earth), turns as arcs within a g limit, banked as a pilot would. It holds "
      "before and "
      "goes on after, unless `ends` says otherwise.",
      {modelKey("route"), required(list("points", "waypoints of a route; it passes the corner at each on an arc that touches both legs", 2, kMostWaypoints)),
       within(number("speed", "m/s", "at all waypoints without one of their own"), 0.0, 1e4),
       withDefault(within(number("begin", "s", "at the first waypoint", &WaypointFlightOptions::begin_s), -kLongestTime_s, kLongestTime_s), "0 s"),
       withDefault(within(above(number("g_limit", "",
                                       "most lateral acceleration of turns, in units of 9.80665 m/s2; turns are flown with it unless a waypoint says less",
                                       &WaypointFlightOptions::mostLateral_g),
                                0.0),
                          0.0, 100.0),
                   "5"),
       withDefault(
           within(above(number("speed_g_limit", "", "most acceleration along the path where speeds differ", &WaypointFlightOptions::mostLongitudinal_g), 0.0),
                  0.0, 100.0),
           "2"),
       withDefault(boolean("bank", "wings bank in turns: tan(bank) is the lateral acceleration over gravity", &WaypointFlightOptions::bank), "true"),
       withDefault(within(number("bank_time", "s", "over which it rolls in and out of turns", &WaypointFlightOptions::bankTime_s), 0.0, 60.0), "1 s"),
       withDefault(within(above(number("step", "s", "between points that are kept", &WaypointFlightOptions::step_s), 0.0), 1e-4, 1.0), "20 ms")}};
  return t;
}

const ParameterTable& routePoint() {
  static const ParameterTable t = [] {
    ParameterTable x{"waypoint of a route", "", positionParameters()};
    x.parameters.push_back(within(number("speed", "m/s", "there: constant through the turn, changed evenly along legs", &FlightWaypoint::speed_m_s), 0.0, 1e4));
    x.parameters.push_back(
        within(above(number("turn_g", "", "lateral acceleration of this turn; `g_limit` unless given", &FlightWaypoint::turn_g), 0.0), 0.0, 100.0));
    return x;
  }();
  return t;
}

const ParameterTable& motionCsv() {
  static const ParameterTable t{
      "motion: csv",
      "A path from a file: a header of names with units, then rows. `time_s`, rising; a set of positions: `x_m, y_m, z_m` (east, north, up from the origin), "
      "`north_m, east_m, down_m`, `latitude_deg, longitude_deg, height_m` (WGS 84) or `ecef_x_m, ecef_y_m, ecef_z_m`; and an attitude or none (then along the "
      "path): "
      "`heading_deg, pitch_deg, roll_deg`, `qw, qx, qy, qz` (body x forward, y left, z up into east, north, up) or `ned_qw, ned_qx, ned_qy, ned_qz` (body x "
      "forward, y right, z down into north, east, down). It holds at both ends unless `ends` says otherwise.",
      {modelKey("csv"), required(text("file", "relative to the scenario"))}};
  return t;
}

}  // namespace tables

MotionEnds readEnds(const Record& r, const MotionEnds& otherwise) {
  MotionEnds ends = otherwise;
  if (!r.given("ends")) return ends;
  const Value& v = r.value("ends");
  if (v.kind != Value::Kind::Map) {
    const std::string word = readText(v, "ends");
    for (const auto& [name, end] : kEnds)
      if (word == name) return {end, end};
    throw unknownWord(v.where, "a motion cannot end with", word, tables::ends().find("after")->choices);
  }
  Record(v, tables::ends()).fill(ends);
  return ends;
}

std::optional<Spin> readSpin(const Record& r) {
  if (!r.given("spin")) return std::nullopt;
  const Record s(r.value("spin"), tables::spin());
  Spin spin;
  s.fill(spin);
  if (!(glm::length(spin.axis) > 0.0)) throw UserError(s.where("axis"), "an axis of length 0", "a direction such as [1, 0, 0]", "correct it");
  spin.axis = glm::normalize(spin.axis);
  if (s.given("rate") == s.given("angle"))
    throw UserError(s.where(), s.given("rate") ? "a spin with a rate and an angle" : "a spin without a rate", "'rate', or 'angle' over time",
                    s.given("rate") ? "remove one" : "add 'rate: 720 deg/s'");
  return spin;
}

Lifetime readLifetime(const Record& r) {
  Lifetime life;
  r.fill(life);
  if (!(life.end_s > life.begin_s)) throw UserError(r.where("end"), "an end at or before the begin", "a later time", "correct 'end' or 'begin'");
  return life;
}

glm::dvec3 readWind(const Value& value) {
  const Record r(value, tables::wind());
  const double from = r.number("direction"), speed = r.number("speed");
  return {-speed * std::sin(from), -speed * std::cos(from), 0.0};
}

std::string motionModelOf(const Value& motion) {
  const Value* model = motion.find("model");
  if (!model) throw UserError(motion.where, "a motion without a model", "a list of waypoints, or 'model' with one of " + listed(kModels), "add 'model: route'");
  const std::string name = readText(*model, "model");
  if (std::find(kModels.begin(), kModels.end(), name) == kModels.end()) throw unknownWord(model->where, "there is no motion", name, kModels);
  return name;
}

bool isFlight(const std::string& model) { return model == "ballistic" || model == "missile"; }

Motion readWaypoints(const Value& all, const LocalFrame& frame, bool attached, bool linear, const MotionEnds& ends) {
  asList(all, "motion");
  if (all.items.empty() || all.items.size() > kMostWaypoints)
    throw UserError(all.where, "motion has " + std::to_string(all.items.size()) + " entries", "1 to " + std::to_string(kMostWaypoints),
                    all.items.empty() ? "add entries" : "remove entries");
  std::vector<Waypoint> waypoints;
  for (const Value& v : all.items) {
    const Record w(v, tables::waypoint());
    Waypoint point;
    point.time_s = w.number("time");
    const auto position = readPosition(w, frame);
    if (!position) throw UserError(w.where(), "no position", "'position: [0 m, 0 m, 100 m]', 'geodetic' or 'motion'", "add it");
    point.position = *position;
    if (w.given("pitch") && !w.given("heading"))
      throw UserError(w.where("pitch"), "a waypoint with a pitch but no heading", "both, or neither (then it follows the path)", "add 'heading:'");
    if (w.given("heading")) point.attitude = readAttitude(w, attached);
    if (w.given("roll")) point.roll_rad = w.number("roll");
    // 1 ns: velocities stay finite however far apart the positions are.
    if (!waypoints.empty() && point.time_s < waypoints.back().time_s + 1e-9)
      throw UserError(w.where("time"), "the times of a motion do not rise", "each waypoint later than the one before", "sort the waypoints");
    waypoints.push_back(point);
  }
  return Motion(std::move(waypoints), linear ? Motion::Interpolation::Linear : Motion::Interpolation::Smooth, ends.before, ends.after);
}

namespace {

UserError refused(const WaypointRefusal& e, const Record& route) {
  using Reason = WaypointRefusal::Reason;
  const Value& points = route.value("points");
  const Value& at = points.items[std::min(e.waypoint, points.items.size() - 1)];
  const std::string allowed = "at most " + std::to_string(e.allowed_g).substr(0, 4) + " g";
  const auto key = [&](const char* name) { return at.find(name) ? at.find(name)->where : at.where; };
  switch (e.reason) {
    case Reason::TurnTooTight:
      return UserError(key("position"), e.what(), allowed, "move this waypoint or its neighbours apart, lower 'speed', or raise 'g_limit'");
    case Reason::TurnAboveLimit:
      return UserError(key("turn_g"), e.what(), allowed, "lower 'turn_g', or raise 'g_limit'");
    case Reason::SpeedChange:
      return UserError(key("speed"), e.what(), allowed, "let the leg be longer, the speeds more alike, or raise 'speed_g_limit'");
    case Reason::NoSpeed:
      return UserError(key("speed"), e.what(), "a speed above 0", "add 'speed: 200 m/s' to the route or to this waypoint");
    case Reason::SamePlace:
      return UserError(key("position"), e.what(), "another place", "remove it, or move it");
    case Reason::TurnsBack:
      return UserError(key("position"), e.what(), "a turn of less than 180 deg", "add a waypoint to one side");
    case Reason::TooLong:
      return UserError(route.where(), e.what(), "at most a million points", "raise 'step', or end the route earlier");
    case Reason::FewPoints:
    case Reason::NotFinite:
    case Reason::Option:
      break;
  }
  return UserError(at.where, e.what(), "a route that can be flown", "correct it");
}

}  // namespace

Trajectory readRoute(const Value& motion, const LocalFrame& frame, const MotionEnds& ends) {
  const Record r(motion, tables::motionRoute());
  WaypointFlightOptions options;
  r.fill(options);
  options.before = ends.before;
  options.after = ends.after;
  std::vector<FlightWaypoint> waypoints;
  for (const Value& v : r.value("points").items) {
    const Record w(v, tables::routePoint());
    const auto position = readPosition(w, frame);
    if (!position) throw UserError(w.where(), "a waypoint without a position", "'position' or 'geodetic'", "add 'position: [0 m, 0 m, 1 km]'");
    if (!w.given("speed") && !r.given("speed"))
      throw UserError(w.where(), "a waypoint without a speed", "'speed' of the waypoint, or of the route for all", "add 'speed: 200 m/s'");
    FlightWaypoint& point = waypoints.emplace_back();
    point.position = *position;
    if (!w.given("speed")) point.speed_m_s = r.number("speed");
    w.fill(point);
  }
  try {
    return flyWaypoints(waypoints, options, frame);
  } catch (const WaypointRefusal& e) {
    throw refused(e, r);
  }
}

}  // namespace pitviper
