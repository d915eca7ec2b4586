#include "sim/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/world/field_states.hpp"

namespace pitviper {
namespace {

void change(const Simulation& sim, const Command& command, double at_s, Courses& courses);

/// The scenario's commands from one on, as far as a time; returns the first that is left.
std::size_t carryOut(const Simulation& sim, std::size_t next, double time_s, Courses& courses) {
  for (; next < sim.commands.size() && sim.commands[next].at_s <= time_s + kSameTick * sim.time.step_s; ++next)
    change(sim, sim.commands[next], sim.commands[next].at_s, courses);
  return next;
}

template <class Map, class Key, class Other>
auto valueOf(const Map& courses, const Key& key, double time_s, const Other& otherwise) {
  const auto set = courses.find(key);
  return set == courses.end() ? otherwise() : set->second(time_s);
}

/// The time for which a body is where its own motion has it.
double routeTime(const Courses& courses, int entity, double time_s) {
  return valueOf(courses.routeTimes_s, entity, time_s, [=] { return time_s; });
}

/// In the local frame, or in its carrier's.
Pose ownPose(const Simulation& sim, const Courses& courses, int entity, double time_s) {
  Pose own = sim.entities[static_cast<size_t>(entity)].motion.at(routeTime(courses, entity, time_s));
  own.position = valueOf(courses.positions, entity, time_s, [&] { return own.position; });
  own.orientation = valueOf(courses.orientations, entity, time_s, [&] { return own.orientation; });
  return own;
}

bool isMoved(const Simulation& sim, const Courses& courses, int entity) {
  for (int e = entity; e >= 0; e = sim.entities[static_cast<size_t>(e)].parent)
    if (courses.positions.count(e) || courses.orientations.count(e) || courses.routeTimes_s.count(e)) return true;
  return false;
}

void eject(const Simulation& sim, int index, double at_s, Courses& courses) {
  const Store& store = sim.stores[static_cast<size_t>(index)];
  if (store.carrier >= 0 && !lifetimeOf(sim, store.carrier).has(at_s)) return;
  auto flies = store.carrier < 0 ? store.eject(at_s, {}, {})
                                 : store.eject(at_s, poseOf(sim, courses, store.carrier, at_s), velocityOf(sim, courses, store.carrier, at_s));
  if (flies) courses.ejected[index] = std::move(flies);
}

void change(const Simulation& sim, const Command& command, double at_s, Courses& courses) {
  command.change(courses, at_s);
  for (const auto& [store, when_s] : courses.toEject) eject(sim, store, when_s, courses);
  courses.toEject.clear();
}

const CameraChange* changeOf(const Camera& camera, const WorldState& state) {
  const auto found = state.cameras.find(camera.name);
  return found == state.cameras.end() ? nullptr : &found->second;
}

/// As it is carried, wherever it looks.
Pose baseOf(const Mount& mount, const CameraChange* change, const WorldState& state) {
  Pose pose = mount.motion.at(state.time_s);
  if (change && change->position) pose.position = *change->position;
  if (change && change->orientation) pose.orientation = *change->orientation;
  if (mount.carrier < 0) return pose;
  const Pose carrier = state.bodyPose(static_cast<size_t>(mount.carrier));
  Pose base = composed(carrier, pose);
  if (mount.steadied.any()) base.orientation = glm::normalize(steadied(mount.steadied, carrier.orientation) * pose.orientation);
  return base;
}

std::optional<glm::dvec3> targetOf(const Mount& mount, const WorldState& state) {
  if (mount.looksAtPoint) return mount.lookAtPoint;
  if (mount.lookAtLight >= 0) return state.lightPoses[static_cast<size_t>(mount.lookAtLight)].position;
  if (mount.lookAtEntity >= 0) return state.bodyPose(static_cast<size_t>(mount.lookAtEntity)).position;
  return std::nullopt;
}

Pose poseOf(const Mount& mount, const CameraChange* change, const WorldState& state) {
  if (change && change->pose) return *change->pose;
  Pose pose = baseOf(mount, change, state);
  if (change && change->orientation) return pose;
  if (const auto target = targetOf(mount, state)) {
    const glm::dvec3 line = *target - pose.position;
    if (glm::dot(line, line) > 0.0) pose.orientation = orientationAlong(line);
  }
  return pose;
}

WorldState stateOf(const Simulation& sim, const Courses& courses, double time_s) {
  WorldState state;
  state.time_s = time_s;
  const auto carried = [&state](int carrier, const Pose& own) { return carrier >= 0 ? composed(state.bodyPose(static_cast<size_t>(carrier)), own) : own; };
  if (std::any_of(sim.entities.begin(), sim.entities.end(), [](const Entity& e) { return e.mesh && e.mesh->offset_m != glm::dvec3(0.0); }))
    for (const Entity& e : sim.entities) state.offsets_m.push_back(e.mesh ? e.mesh->offset_m : glm::dvec3(0.0));
  for (const Entity& e : sim.entities) {  // a parent comes before its children
    const int index = static_cast<int>(state.entities.size());
    const bool there =
        e.lifetime.has(time_s) && e.motion.presentAt(routeTime(courses, index, time_s)) && (e.parent < 0 || state.isThere(static_cast<size_t>(e.parent)));
    if (!there) state.absent.resize(sim.entities.size(), 0);
    if (!there) state.absent[static_cast<size_t>(index)] = 1;
    const Pose body = carried(e.parent, ownPose(sim, courses, index, time_s));
    state.entities.push_back(state.offsets_m.empty() ? body : composed(body, {state.offsets_m[static_cast<size_t>(index)], {1, 0, 0, 0}}));
    if (!sim.fields.empty() && isMoved(sim, courses, index)) state.velocities[index] = velocityOf(sim, courses, index, time_s);
    std::vector<double>& temperatures = state.temperatures_K.emplace_back();
    for (const Surface& s : e.surfaces)
      temperatures.push_back(
          valueOf(courses.temperatures_K, std::pair(index, static_cast<int>(temperatures.size())), time_s, [&] { return s.temperatureAt_K(time_s); }));
  }
  for (const PointLight& l : sim.lights) {
    const int index = l.lamp >= 0 ? l.lamp : static_cast<int>(state.lights.size());
    if (l.store >= 0) {
      const auto flies = courses.ejected.find(l.store);
      const bool lit = flies != courses.ejected.end();
      state.lightPoses.push_back(lit ? Pose{flies->second->path->at(time_s).position, {1, 0, 0, 0}} : Pose{});
      state.lights.push_back(state.lightPoses.back().position);
      state.lightLevels.push_back(lit ? valueOf(courses.lightLevels, index, time_s, [&] { return flies->second->level.at(time_s); }) : 0.0);
      continue;
    }
    const Pose& pose = state.lightPoses.emplace_back(poseOf(l.mount, nullptr, state));
    state.lights.push_back(l.offset_m == glm::dvec3(0.0) ? pose.position : pose.position + pose.orientation * l.offset_m);
    const bool there = l.presentAt(time_s) && (l.mount.carrier < 0 || state.isThere(static_cast<size_t>(l.mount.carrier)));
    state.lightLevels.push_back(there ? valueOf(courses.lightLevels, index, time_s, [&] { return l.levelAt(time_s); }) : 0.0);
  }
  for (const Camera& c : sim.cameras) {
    if (!c.focalLengthOverTime_m.empty()) state.cameras[c.name].focalLength_m = c.focalLengthOverTime_m.at(time_s);
    if (!c.exposureOverTime_s.empty()) state.cameras[c.name].exposure_s = c.exposureOverTime_s.at(time_s);
    for (const auto& [channel, own] : c.ownChannels)
      if (!own.exposureOverTime_s.empty()) state.cameras[c.name].channelExposures_s[channel] = own.exposureOverTime_s.at(time_s);
  }
  for (const auto& [camera, course] : courses.cameraPositions) state.cameras[camera].position = course(time_s);
  for (const auto& [camera, course] : courses.cameraOrientations) state.cameras[camera].orientation = course(time_s);
  for (const auto& [camera, course] : courses.focalLengths_m) state.cameras[camera].focalLength_m = course(time_s);
  for (const auto& [camera, course] : courses.exposures_s) state.cameras[camera].exposure_s = course(time_s);
  for (const auto& [camera, course] : courses.gains) state.cameras[camera].gain = course(time_s);
  for (const auto& [of, course] : courses.channelExposures_s) state.cameras[of.first].channelExposures_s[of.second] = course(time_s);
  for (const auto& [of, course] : courses.channelGains) state.cameras[of.first].channelGains[of.second] = course(time_s);
  for (const auto& [camera, pointings] : courses.pointings) state.cameras[camera].pointings = pointings;
  state.throttles = courses.throttles;
  state.ejected = courses.ejected;
  if (!sim.fields.empty()) state.fields = std::make_shared<const FieldStates>(sim, state);
  return state;
}

}  // namespace

glm::dvec3 velocityOf(const Simulation& sim, int entity, double time_s) {
  const Entity& e = sim.entities[static_cast<size_t>(entity)];
  const glm::dvec3 own = e.motion.velocityAt(time_s);
  if (e.parent < 0) return own;
  const Pose carrier = poseOf(sim, e.parent, time_s);
  // What the carrier's turning adds: a hundredth of a millisecond apart, its turns are straight lines and rounding of a pose is far below.
  constexpr double kApart_s = 1e-5;
  const glm::dvec3 at = e.motion.at(time_s).position;
  const glm::dvec3 turned = poseOf(sim, e.parent, time_s + kApart_s).orientation * at - poseOf(sim, e.parent, time_s - kApart_s).orientation * at;
  return velocityOf(sim, e.parent, time_s) + carrier.orientation * own + turned / (2.0 * kApart_s);
}

Pose poseOf(const Simulation& sim, const Courses& courses, int entity, double time_s) {
  const int parent = sim.entities[static_cast<size_t>(entity)].parent;
  const Pose own = ownPose(sim, courses, entity, time_s);
  return parent >= 0 ? composed(poseOf(sim, courses, parent, time_s), own) : own;
}

glm::dvec3 velocityOf(const Simulation& sim, const Courses& courses, int entity, double time_s) {
  constexpr double kApart_s = 1e-5;  // as above
  const Entity& e = sim.entities[static_cast<size_t>(entity)];
  const auto moved = courses.moved.find(entity);
  const double at = routeTime(courses, entity, time_s);
  const double rate = courses.routeTimes_s.count(entity)
                          ? (routeTime(courses, entity, time_s + kApart_s) - routeTime(courses, entity, time_s - kApart_s)) / (2.0 * kApart_s)
                          : 1.0;
  const glm::dvec3 own = moved != courses.moved.end() ? moved->second.velocity : rate * e.motion.velocityAt(at);
  if (e.parent < 0) return own;
  const glm::dvec3 place = ownPose(sim, courses, entity, time_s).position;
  const auto turned = [&](double t) { return poseOf(sim, courses, e.parent, t).orientation * place; };
  return velocityOf(sim, courses, e.parent, time_s) + poseOf(sim, courses, e.parent, time_s).orientation * own +
         (turned(time_s + kApart_s) - turned(time_s - kApart_s)) / (2.0 * kApart_s);
}

Pose poseOf(const Simulation& sim, int entity, double time_s) {
  const Entity& e = sim.entities[static_cast<size_t>(entity)];
  const Pose own = e.motion.at(time_s);
  return e.parent >= 0 ? composed(poseOf(sim, e.parent, time_s), own) : own;
}

Lifetime lifetimeOf(const Simulation& sim, int entity) {
  const Entity& e = sim.entities[static_cast<size_t>(entity)];
  Lifetime all = e.parent >= 0 ? lifetimeOf(sim, e.parent) : Lifetime{};
  all.begin_s = std::max({all.begin_s, e.lifetime.begin_s, e.motion.before() == AtEnd::Vanish ? e.motion.begin_s() : -INFINITY});
  all.end_s = std::min({all.end_s, e.lifetime.end_s, e.motion.after() == AtEnd::Vanish ? e.motion.end_s() : INFINITY});
  return all;
}

WorldState advance(const Simulation& simulation, double time_s) { return World(simulation).at(time_s); }

WorldState withEjected(const Simulation& sim, double time_s, int look) {
  Courses courses;
  carryOut(sim, 0, time_s, courses);
  // Parts of the time that it burns: most are early, while it is near what ejected it; evenly spread before (the golden ratio's sequence).
  const double even = std::fmod((look + 0.5) * 0.6180339887498949, 1.0), part = 0.02 + 0.9 * even * even * even;
  for (size_t s = 0; s < sim.stores.size(); ++s) {
    const Store& store = sim.stores[s];
    const auto index = static_cast<int>(s);
    if (!courses.ejected.count(index)) eject(sim, index, time_s - store.lit_s - part * (store.out_s - store.lit_s), courses);
  }
  return stateOf(sim, courses, time_s);
}

void move(Courses& courses, int entity, double at_s, const glm::dvec3& position, const std::optional<glm::dvec3>& velocity) {
  Moved now{at_s, position, velocity.value_or(glm::dvec3(0.0))};
  if (const auto before = courses.moved.find(entity); !velocity && before != courses.moved.end()) {
    const double ago_s = at_s - before->second.at_s;
    const glm::dvec3 way = position - before->second.position;
    if (ago_s > 0.0 && ago_s <= kSameWay_s && glm::length(way) <= kFastest_m_s * ago_s) now.velocity = way / ago_s;
    else if (ago_s == 0.0) now.velocity = before->second.velocity;
  }
  courses.moved[entity] = now;
  courses.positions[entity] = [position, at_s, goesOn = velocity.value_or(glm::dvec3(0.0))](double t) { return position + (t - at_s) * goesOn; };
}

void World::apply(const Command& command, int tick) {
  const double at_s = simulation_.time.at(tick);
  if (at_s < since_s_) throw std::invalid_argument("a command for tick " + std::to_string(tick) + ", and a later one has had some");
  since_s_ = at_s;
  next_ = carryOut(simulation_, next_, at_s, courses_);
  change(simulation_, command, std::min(command.at_s, at_s), courses_);
}

WorldState World::at(double time_s) const {
  Courses courses = courses_;
  carryOut(simulation_, next_, time_s, courses);
  return stateOf(simulation_, courses, time_s);
}

CameraState cameraAt(const Camera& camera, const WorldState& state) {
  const CameraChange* change = changeOf(camera, state);
  CameraState at{poseOf(camera.mount, change, state), camera.pinhole, {camera.exposure_s}, {1.0}};
  for (const auto& [channel, own] : camera.ownChannels)
    if (own.exposure_s) at.exposures_s.own[channel] = *own.exposure_s;
  if (change && change->focalLength_m) at.pinhole.focalLength_m = *change->focalLength_m;
  if (change && change->exposure_s) at.exposures_s.common = *change->exposure_s;
  if (change && change->gain) at.gains.common = *change->gain;
  if (change)
    for (const auto& [channel, exposure_s] : change->channelExposures_s) at.exposures_s.own[channel] = exposure_s;
  if (change) at.gains.own = change->channelGains;
  return at;
}

double longestExposure_s(const Camera& camera, const ChannelValues& exposures_s) {
  double longest = camera.outputs.empty() ? exposures_s.common : 0.0;
  for (const ChannelOutput& o : camera.outputs) longest = std::max(longest, exposures_s.of(o.channel));
  return longest;
}

FollowerTick followerTick(const Camera& camera, const WorldState& state, int frame) {
  const CameraChange* change = changeOf(camera, state);
  FollowerTick tick{frame, state.time_s, baseOf(camera.mount, change, state), targetOf(camera.mount, state), 0.0, {}};
  if (camera.mount.lookAtEntity >= 0 && !state.isThere(static_cast<size_t>(camera.mount.lookAtEntity))) tick.target.reset();
  if (change && change->focalLength_m) tick.focalLength_m = *change->focalLength_m;
  if (change) tick.pointings = change->pointings;
  return tick;
}

void addPointing(Courses& courses, const std::string& camera, Pointing pointing) {
  std::vector<Pointing>& all = courses.pointings[camera];
  pointing.number = all.empty() ? 1 : all.back().number + 1;
  constexpr size_t kMost = 64;  // between two ticks: more are not told apart
  if (all.size() >= kMost) all.erase(all.begin());
  all.push_back(pointing);
}

WorldState pointed(WorldState state, const Camera& camera, const Pose& pose) {
  state.cameras[camera.name].pose = pose;
  return state;
}

}  // namespace pitviper
