#include "scenarios/reader/flights.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/reader/builder.hpp"
#include "sim/flight/ballistic.hpp"
#include "sim/flight/flight_error.hpp"
#include "sim/flight/flights.hpp"
#include "sim/flight/point_mass.hpp"
#include "sim/flight/recovery_temperature.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/placement.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

/// Points of a trajectory are this far apart at least: quintic pieces of 10 ms are good to a millimetre at 100 g/s^4.
constexpr double kBetweenPoints_s = 0.01;

/// Keys of both flights: how it starts, how it is integrated, where it ends.
void addFlightKeys(std::vector<Parameter>& p) {
  const std::vector<Parameter> own = {
      required(within(number("launch", "s",
                             "time at which it flies off. It starts at the body's own `position`; of one that is `attached_to` a body, at that place of "
                             "its carrier, with its carrier's velocity, and flies free"),
                      -kLongestTime_s, kLongestTime_s)),
      within(number("speed", "m/s", "at launch, along `heading` and `pitch` (of a carrier: relative to it, along its x axis unless they say otherwise)"), 0.0,
             1e4),
      within(vector3("velocity", "m/s", "at launch instead of a speed: east, north, up; of a carrier relative to it, in its axes (x forward, y left, z up)"),
             -1e4, 1e4),
      withDefault(
          within(above(number("step", "s",
                              "of integration: classical Runge-Kutta of order 4, fixed, cut where tables bend; frames have no say. Gravity of the ellipsoid, "
                              "air of US Standard Atmosphere 1976 with `wind`, Coriolis acceleration where the scenario has an `origin`",
                              &FlightTask::step_s),
                       0.0),
                 1e-5, 1.0),
          "5 ms"),
      within(above(number("duration", "s", "it flies at most; until the scenario's last frame and a second more unless given", &FlightTask::duration_s), 0.0),
             1e-3, 1e6),
      within(number("ground", "m", "height above the ellipsoid at which it ends; that of `ground` unless given, none if it starts below that",
                    &FlightWorld::groundHeight_m),
             -1e4, 1e5)};
  p.insert(p.end(), own.begin(), own.end());
}

Parameter drag(const char* key) {
  return any(key, "drag coefficient on the area: a number, or rows [Mach number, coefficient], straight between and held outside; none unless given");
}

}  // namespace

namespace tables {

const ParameterTable& motionBallistic() {
  static const ParameterTable t = [] {
    ParameterTable x{
        "motion: ballistic",
        "Thrown, without thrust or lift: flares, shells, debris. It is not there before the launch and after its end, unless `ends` says otherwise.",
        {required(choice("model", {"ballistic"}, ""))}};
    addFlightKeys(x.parameters);
    const std::vector<Parameter> own = {
        required(within(above(number("mass", "kg", "at launch", &BallisticOptions::mass_kg), 0.0), 1e-6, 1e7)),
        withDefault(within(number("burnt_share", "", "of the mass, that burns away", &BallisticOptions::burntShare), 0.0, 0.99), "0"),
        withDefault(within(number("ignition", "s", "since launch", &BallisticOptions::ignition_s), 0.0, 1e6), "0 s"),
        within(above(number("burn_time", "s", "from ignition on", &BallisticOptions::burnTime_s), 0.0), 1e-6, 1e6),
        withDefault(
            within(number("burn_exponent", "", "1: mass falls evenly; 3: as of a grain that shrinks on all sides", &BallisticOptions::burnExponent), 1.0, 10.0),
            "1"),
        within(number("area", "m2", "that drag is of"), 0.0, 1e6),
        within(number("diameter", "m", "instead of an area: that of a circle"), 0.0, 1e3),
        drag("drag"),
        within(above(number("ballistic_coefficient", "kg/m2", "instead of drag and area: mass at launch over drag coefficient and area",
                            &BallisticOptions::ballisticCoefficient_kg_m2),
                     0.0),
               1e-6, 1e9),
        within(course("area_factor", "", "factor on the area over time since launch"), 0.0, 1e6)};
    x.parameters.insert(x.parameters.end(), own.begin(), own.end());
    return x;
  }();
  return t;
}

const ParameterTable& motionMissile() {
  static const ParameterTable t = [] {
    ParameterTable x{"motion: missile",
                     "A point mass with thrust, drag and lift, guided by a textbook law: enough that a scenario runs by itself; no seeker, no autopilot but a "
                     "lag. It is not "
                     "there before the launch and after its end, unless `ends` says otherwise.",
                     {required(choice("model", {"missile"}, ""))}};
    addFlightKeys(x.parameters);
    const std::vector<Parameter> own = {
        required(within(above(number("mass", "kg", "at launch, propellant included", &PointMassOptions::launchMass_kg), 0.0), 1e-3, 1e7)),
        within(course("thrust", "N", "over time since launch: rows, none before the first and after the last; one number: as long as it flies"), 0.0, 1e9),
        within(number("propellant", "kg", "mass burnt in proportion to thrust", &PointMassOptions::propellantMass_kg), 0.0, 1e7),
        within(above(number("specific_impulse", "s", "instead of the propellant's mass: total impulse over weight of propellant",
                            &PointMassOptions::specificImpulse_s),
                     0.0),
               1.0, 1e4),
        within(number("area", "m2", "that coefficients are of"), 0.0, 1e6),
        within(number("diameter", "m", "instead of an area: that of a circle"), 0.0, 1e3),
        drag("drag"),
        within(number("g_limit", "", "most lateral acceleration, in units of 9.80665 m/s2; none unless given", &PointMassOptions::mostLateral_g), 0.0, 1e4),
        within(number("lift_coefficient", "", "most that the air gives, on the same area; no such limit unless given", &PointMassOptions::mostLiftCoefficient),
               0.0, 1e3),
        text("target", "name of an entity"),
        choice("guidance", {"none", "pursuit", "true_pn", "pure_pn"},
               "true_pn: N V_c (w x r), across the line of sight, as published for a point mass: what of it is along the way changes the speed; pure_pn: N w x "
               "v, across the velocity; pursuit: velocity turned to the line of sight (Zarchan, "
               "Tactical and Strategic Missile Guidance, ch. 2; Shneydor, Missile Guidance and Pursuit, ch. 3 and 5). With a target true_pn unless given, else "
               "none"),
        withDefault(within(number("navigation_constant", "", "N of proportional navigation", &GuidanceOptions::navigationConstant), 1.0, 10.0), "4"),
        withDefault(
            within(number("pursuit_gain", "1/s", "of pursuit: how fast an error of direction is turned away", &GuidanceOptions::pursuitGain_per_s), 0.0, 1e3),
            "2 Hz"),
        withDefault(within(number("guided_from", "s", "since launch", &GuidanceOptions::begin_s), 0.0, 1e6), "0 s"),
        withDefault(
            within(number("time_constant", "s", "lag of what is flown behind what is commanded, first order", &GuidanceOptions::timeConstant_s), 0.0, 100.0),
            "0 s"),
        withDefault(within(number("stop_within", "m", "it ends at its closest approach to the target if that is within this; it goes on if it misses by more",
                                  &FlightTask::stopWithin_m),
                           0.0, 1e9),
                    "30 m")};
    x.parameters.insert(x.parameters.end(), own.begin(), own.end());
    return x;
  }();
  return t;
}

const ParameterTable& recovery() {
  static const ParameterTable t{
      "temperature by recovery",
      "What air heats a skin to that it flows along, at the body's speed through the air and its height over time, in the US Standard Atmosphere 1976: T (1 + "
      "0.2 r "
      "M^2). A skin that radiates and conducts is colder. Valid for attached flow to about Mach 5.",
      {required(choice(
           "recovery", {"turbulent", "laminar"},
           "the boundary layer: r is the cube root or the square root of the Prandtl number 0.71, 0.892 or 0.843 (White, Viscous Fluid Flow, sections 4-3.2 "
           "and 7-4)")),
       within(number("factor", "", "r itself, instead of that"), 0.0, 1.0), within(number("offset", "K", "added to it"), -1000.0, 1000.0)}};
  return t;
}

}  // namespace tables

namespace {

/// Rows [x, y] with rising x, or one number.
std::vector<CurvePoint> readDrag(const Value& value) {
  std::vector<CurvePoint> points;
  const auto coefficient = [](const Value& v) {
    const double c = readNumber(v, "", "drag");
    if (!(c >= 0.0 && c <= 1e3)) throw UserError(v.where, "drag is out of range (" + v.text.substr(0, 40) + ")", "a coefficient of 0 to 1000", "correct it");
    return c;
  };
  if (value.kind == Value::Kind::Scalar) return {{0.0, coefficient(value)}};
  for (const Value& row : asList(value, "drag").items) {
    if (row.kind != Value::Kind::List || row.items.size() != 2)
      throw UserError(row.where, "not a row [Mach number, drag coefficient]", "rows such as [0.8, 0.3]", "write two numbers");
    const double mach = readNumber(row.items[0], "", "Mach number");
    if (!points.empty() && !(mach > points.back().x))
      throw UserError(row.items[0].where, "the Mach numbers of drag do not rise", "each row's greater than that before", "sort the rows");
    points.push_back({mach, coefficient(row.items[1])});
  }
  if (points.empty()) throw UserError(value.where, "drag without rows", "a number, or rows [Mach number, coefficient]", "add rows");
  return points;
}

/// A course as straight pieces: cubics by 32 each, which are then good to a thousandth of their rise; steps as rises within a microsecond.
std::vector<CurvePoint> pieces(const Record& r, const char* key, double end_s) {
  const TimeCourse c = r.course(key);
  if (c.outside() == TimeCourse::Outside::Loop)
    throw UserError(r.where(key), std::string("a ") + key + " that loops", "rows for the whole flight", "write them all");
  const auto& points = c.points();
  if (points.size() == 1) return {{std::min(points[0].time_s, 0.0), points[0].value}, {end_s, points[0].value}};
  std::vector<CurvePoint> all;
  constexpr int kPieces = 32;
  constexpr double kJump_s = 1e-6;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && c.interpolation() == TimeCourse::Interpolation::Steps && points[i].time_s - kJump_s > points[i - 1].time_s)
      all.push_back({points[i].time_s - kJump_s, points[i - 1].value});
    for (int k = 1; i > 0 && c.interpolation() == TimeCourse::Interpolation::Smooth && k < kPieces; ++k) {
      const double t = points[i - 1].time_s + (points[i].time_s - points[i - 1].time_s) * k / kPieces;
      all.push_back({t, c.at(t)});
    }
    all.push_back({points[i].time_s, points[i].value});
  }
  return all;
}

double areaOf(const Record& r) {
  if (r.given("area") && r.given("diameter")) throw UserError(r.where("diameter"), "an area and a diameter", "one of the two", "remove one");
  if (r.given("diameter")) return 0.25 * kPi * r.number("diameter") * r.number("diameter");
  return r.given("area") ? r.number("area") : 0.0;
}

void needArea(const Record& r) {
  if (r.given("drag") && !r.given("area") && !r.given("diameter"))
    throw UserError(r.where("drag"), "a drag coefficient without an area", "'area' or 'diameter'", "add 'diameter: 0.13 m'");
}

std::shared_ptr<const FlyingBody> ballisticOf(const Record& r) {
  BallisticOptions o;
  r.fill(o);
  if (o.burntShare > 0.0 && !r.given("burn_time"))
    throw UserError(r.where("burnt_share"), "a mass that burns in no time", "'burn_time'", "add 'burn_time: 4 s'");
  needArea(r);
  o.area_m2 = areaOf(r);
  if (r.given("drag")) o.drag = readDrag(r.value("drag"));
  if (r.given("area_factor")) o.areaFactor = pieces(r, "area_factor", 1e6);
  return std::make_shared<const Ballistic>(std::move(o));
}

std::shared_ptr<const FlyingBody> missileOf(const Record& r, double duration_s) {
  PointMassOptions o;
  r.fill(o);
  if (r.given("thrust")) o.thrust = pieces(r, "thrust", duration_s);
  needArea(r);
  o.referenceArea_m2 = areaOf(r);
  if (r.given("drag")) o.drag = readDrag(r.value("drag"));
  return std::make_shared<const PointMass>(std::move(o));
}

/// An entity as guidance sees it, on the way that the scenario gives it.
PointMotion targetMotion(const Simulation& sim, int entity) {
  const Entity& e = sim.entities[static_cast<std::size_t>(entity)];
  if (e.parent < 0 && e.motion.path()) return motionOf(*e.motion.path());
  return [&sim, entity](double t) {
    // A quadratic through velocities a hundredth of a second apart: laws of guidance look at place and velocity, acceleration is told to those who ask.
    constexpr double kApart_s = 0.01;
    const glm::dvec3 change = velocityOf(sim, entity, t + kApart_s) - velocityOf(sim, entity, t - kApart_s);
    return MovingPoint{poseOf(sim, entity, t).position, velocityOf(sim, entity, t), change / (2.0 * kApart_s)};
  };
}

std::optional<GuidanceOptions> guidanceOf(const Record& r, bool hasTarget) {
  const std::string law = r.given("guidance") ? r.text("guidance") : hasTarget ? "true_pn" : "none";
  if (law == "none") return std::nullopt;
  if (!hasTarget)
    throw UserError(r.where("guidance"), "guidance without a target", "'target', the name of an entity", "add 'target: <entity>', or write 'guidance: none'");
  GuidanceOptions o;
  o.law = law == "pursuit" ? GuidanceLaw::Pursuit : law == "pure_pn" ? GuidanceLaw::PureProportional : GuidanceLaw::TrueProportional;
  r.fill(o);
  return o;
}

/// Where a key stands that an option of a flight is read from.
UserError refused(const FlightError& e, const Record& motion) {
  const Value* at = motion.whole().find(e.option);
  const Location& where = !at ? motion.where() : e.item && *e.item < at->items.size() ? at->items[*e.item].where : at->where;
  return UserError(where, e.option + ": " + e.wrong, e.expected, e.fix);
}

/// Where it starts and how fast.
Launch launchOf(const Simulation& sim, const FlightAsked& asked, const Record& r) {
  const double time_s = r.number("launch");
  if (r.given("speed") && r.given("velocity")) throw UserError(r.where("velocity"), "a speed and a velocity", "one of the two", "remove one");
  const double speed = r.given("speed") ? r.number("speed") : 0.0;
  const bool attached = asked.carrier >= 0;
  const auto position = readPosition(asked.owner, sim.frame);
  const auto attitude = asked.attitude ? readAttitude(asked.owner, attached) : std::nullopt;
  const glm::dvec3 ahead = attitude ? orientationFrom(*attitude) * glm::dvec3(1, 0, 0) : glm::dvec3(1, 0, 0);
  if (attached) {
    const Pose carrier = poseOf(sim, asked.carrier, time_s);
    const glm::dvec3 ejection = r.given("velocity") ? r.vector("velocity") : speed * ahead;
    Launch launch = launchFrom(time_s, carrier, velocityOf(sim, asked.carrier, time_s), position.value_or(glm::dvec3(0.0)), ejection);
    launch.direction = carrier.orientation * ahead;
    return launch;
  }
  if (!position)
    throw UserError(asked.owner.where(), "'" + asked.name.substr(0, 60) + "' flies from nowhere",
                    "its 'position' or 'geodetic' at launch, or 'attached_to' a body", "add 'position: [0 m, 0 m, 1 km]'");
  Launch launch;
  launch.time_s = time_s;
  launch.position = *position;
  launch.direction = ahead;
  if (!attitude && asked.target >= 0) {
    const glm::dvec3 line = poseOf(sim, asked.target, time_s).position - *position;
    if (glm::length(line) > 0.0) launch.direction = glm::normalize(line);
  } else if (!attitude && !r.given("velocity") && (speed > 0.0 || r.given("thrust"))) {
    throw UserError(r.where("speed"), "a launch without a direction", "'heading' and 'pitch' of the body, 'velocity', or a 'target'", "add 'heading: 90 deg'");
  }
  launch.velocity = r.given("velocity") ? r.vector("velocity") : speed * launch.direction;
  if (r.given("velocity") && !attitude && glm::length(launch.velocity) > 0.0) launch.direction = glm::normalize(launch.velocity);
  return launch;
}

}  // namespace

const Value* flightTarget(const Value& motion) { return motion.kind == Value::Kind::Map && isFlight(motionModelOf(motion)) ? motion.find("target") : nullptr; }

FlightRecord flyAsked(const Simulation& sim, const FlightAsked& asked, const MotionEnds& ends) {
  const std::string model = motionModelOf(*asked.motion);
  const bool missile = model == "missile";
  const Record r(*asked.motion, missile ? tables::motionMissile() : tables::motionBallistic());
  const double last_s = sim.time.at(sim.time.frames - 1), launch_s = r.number("launch");
  if (launch_s > last_s)
    throw UserError(r.where("launch"), "'" + asked.name.substr(0, 60) + "' is launched after the last frame, which is at " + briefNumber(last_s) + " s",
                    "a time before it", "launch it earlier, or raise 'frames' under 'time:'");
  FlightTask task;
  task.launch = launchOf(sim, asked, r);
  // A second beyond the last frame: exposures and lines of a shutter reach into it.
  task.duration_s = last_s - launch_s + 1.0;
  r.fill(task);
  task.keepEvery = std::max(1, static_cast<int>(std::round(kBetweenPoints_s / task.step_s)));
  task.before = ends.before;
  task.after = ends.after;
  FlightWorld world;
  world.frame = sim.frame;
  world.coriolis = asked.coriolis;
  if (glm::length(sim.wind_m_s) > 0.0) world.wind = {{0.0, sim.wind_m_s}};
  world.groundHeight_m = sim.frame.ground_m();
  r.fill(world);
  task.stopAtGround = r.given("ground") || heightIn(world, task.launch.position) > world.groundHeight_m;
  FlightRecord record{model, Trajectory({TrajectoryPoint{}}), "", "", {}};
  if (asked.target >= 0) {
    task.target = targetMotion(sim, asked.target);
    record.target = sim.entities[static_cast<std::size_t>(asked.target)].name;
  }
  if (missile) task.guidance = guidanceOf(r, asked.target >= 0);
  try {
    task.body = missile ? missileOf(r, task.duration_s) : ballisticOf(r);
    FlightResult flown = fly(task, world);
    record.trajectory = std::move(flown.trajectory);
    record.end = flown.end == FlightEnd::Ground ? "ground" : flown.end == FlightEnd::ClosestApproach ? "closest approach" : "duration";
    if (flown.closest) record.closest = FlightRecord::Closest{flown.closest->time_s, flown.closest->distance_m};
  } catch (const FlightError& e) {
    throw refused(e, r);
  }
  return record;
}

bool isRecovery(const Value& temperature) { return temperature.kind == Value::Kind::Map && temperature.find("recovery"); }

TimeCourse readRecovery(const Simulation& sim, int entity, const Value& value) {
  const Record r(value, tables::recovery());
  const BoundaryLayer layer = r.text("recovery") == "laminar" ? BoundaryLayer::Laminar : BoundaryLayer::Turbulent;
  const double share = r.given("factor") ? r.number("factor") / recoveryFactor(layer) : 1.0, offset_K = r.given("offset") ? r.number("offset") : 0.0;
  FlightWorld world;
  world.frame = sim.frame;
  const auto temperature = [&](double t) {
    const double height = heightIn(world, poseOf(sim, entity, t).position);
    const double still = recoveryTemperatureAt_K(height, 0.0, layer),
                 moved = recoveryTemperatureAt_K(height, glm::length(velocityOf(sim, entity, t) - sim.wind_m_s), layer);
    return still + share * (moved - still) + offset_K;
  };
  // Straight between points: at 40 g from rest the temperature bends by 140 K/s^2, of which 20 ms leave 7 mK. Of long scenarios more, and fewer points.
  constexpr double kApart_s = 0.02;
  constexpr int kMostPoints = 20000;
  const Lifetime life = lifetimeOf(sim, entity);
  const double from = std::max(sim.time.at(0) - sim.time.step_s, life.begin_s), to = std::min(sim.time.at(sim.time.frames - 1) + sim.time.step_s, life.end_s);
  std::vector<TimeCourse::Point> points;
  const int count = to > from ? static_cast<int>(std::clamp(std::ceil((to - from) / kApart_s), 1.0, static_cast<double>(kMostPoints))) : 0;
  for (int k = 0; k <= count; ++k) {
    const double t = count > 0 ? from + (to - from) * k / count : from;
    points.push_back({t, temperature(t)});
    if (!(points.back().value >= 0.0 && points.back().value <= 1e5))
      throw UserError(value.where, "a temperature by recovery of " + briefNumber(points.back().value) + " K at " + briefNumber(t) + " s", "0 to 100000 K",
                      "check the body's speed and height, and 'offset'");
  }
  const auto [low, high] = std::minmax_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  if (low->value == high->value) return TimeCourse(low->value);
  return TimeCourse(std::move(points));
}

}  // namespace pitviper
