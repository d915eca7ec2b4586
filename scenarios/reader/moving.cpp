// Motions, lifetimes and temperatures over time of a scenario's bodies, lights and cameras.
#include <algorithm>

#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/flights.hpp"
#include "scenarios/reader/tables.hpp"
#include "sim/flight/trajectory_csv.hpp"
#include "sim/scene/placement.hpp"

namespace pitviper {
namespace {

/// Where a motion says where it is, and what else does not belong beside it.
void refuseBeside(const Record& r, bool position, bool attitude) {
  for (const char* key : {"position", "geodetic"})
    if (position && r.given(key)) throw UserError(r.where("motion"), "a position and a motion", "one of the two", "remove one");
  for (const char* key : {"heading", "pitch", "roll"})
    if (attitude && r.given(key))
      throw UserError(r.where(key), std::string("a ") + key + " and a motion", "the attitude in the waypoints, or along the path",
                      std::string("move '") + key + "' into the waypoints");
}

std::shared_ptr<const FlightRecord> recordOf(const char* model, const Trajectory& path) {
  return std::make_shared<const FlightRecord>(FlightRecord{model, path, "end of path", "", {}});
}

}  // namespace

void Builder::readAirMotion(const Record& scenario) {
  hasOrigin_ = scenario.given("origin");
  if (scenario.given("wind")) simulation_.wind_m_s = readWind(scenario.value("wind"));
}

Builder::Placement Builder::readPlacement(const Record& r, Mover mover) {
  const bool attitude = mover != Mover::Light;
  Placement p;
  if (mover != Mover::Camera) p.lifetime = readLifetime(r);
  if (r.given("attached_to")) {
    p.carrier = entityNamed(r.value("attached_to"));
    if (r.given("geodetic"))
      throw UserError(r.where("geodetic"), "a geodetic position of something attached to a body", "'position' in the body's axes", "use 'position'");
  }
  const bool attached = p.carrier >= 0;
  const auto spin = readSpin(r);
  const auto spun = [&](const Motion& m) { return spin ? m.withSpin(*spin) : m; };
  // A camera is always there: what would vanish holds.
  const AtEnd gone = mover == Mover::Camera ? AtEnd::Hold : AtEnd::Vanish;
  const auto endsOf = [&](const MotionEnds& otherwise) {
    const MotionEnds ends = readEnds(r, otherwise);
    if (mover == Mover::Camera && (ends.before == AtEnd::Vanish || ends.after == AtEnd::Vanish))
      throw UserError(r.where("ends"), "a camera that vanishes", "hold, go_on or loop", "write 'ends: hold'");
    return ends;
  };
  if (!r.given("motion")) {
    if (r.given("ends")) throw UserError(r.where("ends"), "the ends of no motion", "'motion', or 'begin' and 'end'", "remove 'ends'");
    Pose fixed;
    fixed.position = readPosition(r, simulation_.frame).value_or(glm::dvec3(0.0));
    if (attitude) {
      // Not turned: the body's x, y, z are east, north, up (or the carrier's own axes).
      if (const auto given = readAttitude(r, attached)) fixed.orientation = orientationFrom(*given);
    }
    p.motion = spun(Motion(fixed));
    return p;
  }
  const Value& motion = r.value("motion");
  const bool linear = r.text("interpolation") == "linear";
  if (motion.kind != Value::Kind::Map) {
    refuseBeside(r, true, attitude);
    p.motion = spun(readWaypoints(motion, simulation_.frame, attached, linear, endsOf({})));
    return p;
  }
  const std::string model = motionModelOf(motion);
  if (isFlight(model)) {
    p.fliesLater = true;
    endsOf({gone, gone});
    if (spin) p.motion = Motion().withSpin(*spin);
    return p;
  }
  refuseBeside(r, true, attitude);
  if (model == "waypoints") {
    const Record m(motion, tables::motionWaypoints());
    p.motion = spun(
        readWaypoints(m.value("points"), simulation_.frame, attached, m.given("interpolation") ? m.text("interpolation") == "linear" : linear, endsOf({})));
    return p;
  }
  if (attached)
    throw UserError(motion.where, "a " + model + " of something attached to a body",
                    "a motion over the earth, of what is not attached; or waypoints in the body's axes", "remove 'attached_to'");
  if (model == "route") {
    const Trajectory path = readRoute(motion, simulation_.frame, endsOf({AtEnd::Hold, AtEnd::GoOn}));
    p.flight = recordOf("route", path);
    p.motion = spun(Motion(path));
    return p;
  }
  const Record m(motion, tables::motionCsv());
  std::filesystem::path file = m.text("file");
  if (file.is_relative()) file = base_ / file;
  const MotionEnds ends = endsOf({});
  const Trajectory path = readTrajectoryCsv(file, simulation_.frame, ends.before, ends.after, m.where("file"));
  p.flight = recordOf("csv", path);
  p.motion = spun(Motion(path));
  return p;
}

void Builder::readLookAt(const Record& r, const std::string& what, Mount& mount) const {
  if (!r.given("look_at")) {
    if (!r.given("heading") && !r.given("pitch") && !r.given("motion") && mount.carrier < 0)
      throw UserError(r.where(), what + " '" + r.text("name") + "' looks nowhere", "'look_at', 'heading' and 'pitch', a motion, or 'attached_to'",
                      "add 'look_at: <entity>'");
    return;
  }
  for (const char* key : {"heading", "pitch", "roll"})
    if (r.given(key) && !r.given("gimbal"))  // whose base they turn
      throw UserError(r.where(key), std::string("a ") + key + " and a look_at", "one of the two", "remove one");
  const Value& target = r.value("look_at");
  if (target.kind == Value::Kind::List || (target.kind == Value::Kind::Scalar && target.text.find(',') != std::string::npos)) {
    mount.looksAtPoint = true;
    mount.lookAtPoint = readVector(target, "m", "look_at");
    if (!(glm::length(mount.lookAtPoint) <= 1e9))
      throw UserError(target.where, "look_at is more than a million km away", "metres from the origin", "check the unit");
    return;
  }
  const auto light = std::find_if(simulation_.lights.begin(), simulation_.lights.end(), [&](const PointLight& l) { return l.name == target.text; });
  if (light != simulation_.lights.end() && entityNames_.count(target.text) == 0) mount.lookAtLight = static_cast<int>(light - simulation_.lights.begin());
  else mount.lookAtEntity = entityNamed(target);
  if (mount.lookAtEntity >= 0 && mount.lookAtEntity == mount.carrier)
    throw UserError(target.where, "a " + what + " looks at the body that carries it", "another body", "change look_at");
}

int Builder::targetNamed(const Value& asked) const {
  const std::string name = readText(asked, "target");
  const auto found = entityIndex_.find(name);
  if (found != entityIndex_.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [n, i] : entityIndex_) names.push_back(n);
  throw unknownWord(asked.where, "there is no entity", name, names, "add it under 'entities:'");
}

void Builder::flyNow(const Record& r, Mover mover, Placement& p) {
  constexpr double kMostSteps = 1e7;  // as of one flight: seconds of work; 1 GB where each is kept
  const Value& motion = r.value("motion");
  const Value* target = flightTarget(motion);
  const AtEnd gone = mover == Mover::Camera ? AtEnd::Hold : AtEnd::Vanish;
  const FlightAsked asked{r.text("name"), r, &motion, mover != Mover::Light, p.carrier, target ? targetNamed(*target) : -1, hasOrigin_};
  p.flight = std::make_shared<const FlightRecord>(flyAsked(simulation_, asked, readEnds(r, {gone, gone})));
  const Record flown(motion, motionModelOf(motion) == "missile" ? tables::motionMissile() : tables::motionBallistic());
  stepsFlown_ += (p.flight->trajectory.end_s() - p.flight->trajectory.begin_s()) / flown.number("step");
  if (stepsFlown_ > kMostSteps)
    throw UserError(motion.where, "flights of " + std::to_string(static_cast<long long>(stepsFlown_)) + " steps, this one and those before it",
                    "at most 10 million in a scenario", "take longer steps, shorter flights or fewer of them");
  const auto spin = p.motion.spin();
  p.motion = Motion(p.flight->trajectory);
  if (spin) p.motion = p.motion.withSpin(*spin);
  p.carrier = -1;
  p.fliesLater = false;
}

void Builder::flyAll() {
  enum class Is { Waiting, Begun, Done };
  std::map<int, Is> all;
  for (const auto& [e, written] : fliesLater_) all[e] = Is::Waiting;
  std::vector<int> way;
  const std::function<void(int)> settle = [&](int e) {
    const auto found = all.find(e);
    Entity& body = simulation_.entities[static_cast<size_t>(e)];
    if (found == all.end()) {
      if (body.parent >= 0) settle(body.parent);
      return;
    }
    if (found->second == Is::Done) return;
    const Record r(*fliesLater_.at(e), tables::entity());
    if (found->second == Is::Begun) {
      std::string names;
      for (auto at = std::find(way.begin(), way.end(), e); at != way.end(); ++at)
        names += "'" + simulation_.entities[static_cast<size_t>(*at)].name.substr(0, 60) + "' waits for ";
      throw UserError(r.where("motion"), "flights that depend on each other: " + names + "'" + body.name.substr(0, 60) + "'",
                      "a target and a carrier whose ways are known before", "let one of them fly a route, along waypoints or at no target");
    }
    found->second = Is::Begun;
    way.push_back(e);
    if (body.parent >= 0) settle(body.parent);
    if (const Value* target = flightTarget(r.value("motion"))) {
      const int other = targetNamed(*target);
      if (other == e) throw UserError(target->where, "'" + body.name.substr(0, 60) + "' flies at itself", "another entity", "change 'target'");
      settle(other);
    }
    Placement p;
    p.motion = body.motion;
    p.carrier = body.parent;
    flyNow(r, Mover::Entity, p);
    body.motion = p.motion;
    body.parent = p.carrier;
    body.flight = p.flight;
    way.pop_back();
    all[e] = Is::Done;
  };
  for (const auto& [e, written] : fliesLater_) settle(e);
}

void Builder::readTemperature(const Value& value, int entity, int surface, Surface& s) {
  if (isRecovery(value)) {
    Record(value, tables::recovery());
    recoveries_.push_back({entity, surface, &value});
    return;
  }
  constexpr double kHottest_K = 1e5;
  if (!isCourse(value)) {
    s.temperature_K = readNumber(value, "K", "temperature");
    if (s.temperature_K < 0.0 || s.temperature_K > kHottest_K)
      throw UserError(value.where, "temperature is out of range (" + value.text.substr(0, 40) + ")", "0 to 100000 K", "correct it");
    checkTemperatures(s.material, s.temperature_K, s.temperature_K, value.where);
    return;
  }
  const TimeCourse course = readCourse(value, "K", "temperature", 0.0, kHottest_K);
  const double first = simulation_.time.at(0), last = simulation_.time.at(simulation_.time.frames - 1);
  s.temperature_K = course.at(first);
  if (!course.isConstant()) s.temperature = course;
  const auto [low, high] = course.range(first, last);
  checkTemperatures(s.material, low, high, value.where);
}

void Builder::readRecoveries() {
  std::map<std::pair<int, const Value*>, TimeCourse> known;  // parts that share one
  for (const Recovery& asked : recoveries_) {
    auto [at, fresh] = known.try_emplace({asked.entity, asked.value});
    if (fresh) at->second = readRecovery(simulation_, asked.entity, *asked.value);
    Surface& s = simulation_.entities[static_cast<size_t>(asked.entity)].surfaces[static_cast<size_t>(asked.surface)];
    s.temperature_K = at->second.at(simulation_.time.at(0));
    if (!at->second.isConstant()) s.temperature = at->second;
    const auto [low, high] = at->second.range(simulation_.time.at(0), simulation_.time.at(simulation_.time.frames - 1));
    checkTemperatures(s.material, low, high, asked.value->where);
  }
}

}  // namespace pitviper
