#include "sim/stream/cigi_world.hpp"

#include <cmath>

#include "sim/parameters/print.hpp"
#include "sim/stream/command_models.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

std::string number(double v) { return print("%.9g", v); }

/// Axes x north, y west, z up as directions of a local east-north-up frame.
glm::dquat northWestUp() { return orientationFrom(Attitude{}); }

Command now(decltype(Command::change) change) { return {NAN, "CIGI", std::move(change)}; }

/// A course as it is now, or what the scenario says.
template <class T, class Map>
T at(const Map& courses, int key, double time_s, const T& otherwise) {
  const auto found = courses.find(key);
  return found == courses.end() ? otherwise : found->second(time_s);
}

/// A turn at a constant rate about fixed axes, after a time.
glm::dquat turned(const glm::dvec3& rate_rad_s, double time_s) {
  const double rate = glm::length(rate_rad_s);
  return rate > 0.0 ? glm::angleAxis(rate * time_s, rate_rad_s / rate) : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

/// The axes that a rate is told in, as directions of the local frame, or of the carrier's.
glm::dquat axesOf(const CigiRate& rate, bool isFree, const glm::dquat& own) {
  return rate.ownAxes ? own : isFree ? northWestUp() : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

}  // namespace

void CigiWorld::translate(const std::vector<CigiChange>& changes, std::vector<Command>& commands, const Refuse& refuse) {
  for (const CigiChange& change : changes) std::visit([&](const auto& c) { of(c, commands, refuse); }, change);
}

int CigiWorld::entity(int id, const Refuse& refuse) const {
  if (id >= 1 && id <= static_cast<int>(simulation_.entities.size())) return id - 1;
  refuse("entity " + std::to_string(id) + " is none of 1 to " + std::to_string(simulation_.entities.size()));
  return -1;
}

int CigiWorld::partOf(int entity, int part, const Refuse& refuse) const {
  int count = 0;
  for (std::size_t e = 0; e < simulation_.entities.size(); ++e)
    if (simulation_.entities[e].parent == entity && ++count == part) return static_cast<int>(e);
  refuse("part " + std::to_string(part) + " of entity " + std::to_string(entity + 1) + ", to which " + std::to_string(count) + " are attached");
  return -1;
}

std::vector<int> CigiWorld::cameras(int view, int group, const Refuse& refuse) const {
  std::vector<int> all;
  const int count = static_cast<int>(simulation_.cameras.size());
  if (group != 0) {
    for (int c = 0; c < count; ++c) all.push_back(c);
  } else if (view <= count && count > 0) {
    all.push_back(std::max(0, view - 1));
  } else {
    refuse("view " + std::to_string(view) + " is none of 0 to " + std::to_string(count));
  }
  return all;
}

void CigiWorld::worded(const std::vector<std::pair<std::string, std::string>>& words, std::vector<Command>& commands, const Refuse& refuse) const {
  try {
    commands.push_back(commandOf(words, "CIGI", simulation_, NAN));
  } catch (const UserError& e) {
    refuse(e.what());
  }
}

void CigiWorld::of(const CigiEntityPose& p, std::vector<Command>& commands, const Refuse& refuse) {
  const int e = entity(p.entity, refuse);
  if (e < 0) return;
  const int parent = simulation_.entities[static_cast<std::size_t>(e)].parent;
  if (p.attached ? p.parent - 1 != parent : parent >= 0)
    return refuse("entity " + std::to_string(p.entity) + (parent < 0 ? " stands by itself" : " is attached to entity " + std::to_string(parent + 1)) +
                  " in the scenario, and stays so");
  if (p.state != CigiEntityState::Active) return refuse("entity " + std::to_string(p.entity) + " is to be gone, and every body of the scenario stays in it");
  const LocalFrame& frame = simulation_.frame;
  const glm::dvec3 position = p.attached ? p.position : frame.toLocal(p.geodetic);
  const glm::dquat orientation = p.attached ? p.orientation : glm::normalize(glm::inverse(glm::quat_cast(frame.ecefFromLocal())) * p.orientation);
  const auto rate = rates_.find(e);
  const CigiRate goesOn = rate == rates_.end() ? CigiRate{} : rate->second;
  const glm::dquat axes = axesOf(goesOn, parent < 0, orientation);
  const glm::dvec3 turning = axes * goesOn.angular_rad_s;
  const std::optional<glm::dvec3> velocity = rate == rates_.end() ? std::nullopt : std::optional(axes * goesOn.linear_m_s);
  commands.push_back(now([=](Courses& courses, double at_s) {
    move(courses, e, at_s, position, velocity);
    courses.orientations[e] = [=](double t) { return turned(turning, t - at_s) * orientation; };
  }));
}

void CigiWorld::of(const CigiRate& r, std::vector<Command>& commands, const Refuse& refuse) {
  int e = entity(r.entity, refuse);
  if (e >= 0 && r.part) e = partOf(e, *r.part, refuse);
  if (e < 0) return;
  const Entity& body = simulation_.entities[static_cast<std::size_t>(e)];
  // Of a body by itself the axes are north, west, up at its place; over the way that a rate holds the local frame's are as good (0.01 degree a kilometre).
  rates_[e] = r;
  commands.push_back(now([=, motion = body.motion, free = body.parent < 0](Courses& courses, double at_s) {
    const Pose own = motion.at(at_s);
    const glm::dvec3 p = at(courses.positions, e, at_s, own.position);
    const glm::dquat q = at(courses.orientations, e, at_s, own.orientation);
    const glm::dquat axes = axesOf(r, free, q);
    const glm::dvec3 velocity = axes * r.linear_m_s, turning = axes * r.angular_rad_s;
    move(courses, e, at_s, p, velocity);
    courses.orientations[e] = [=](double t) { return turned(turning, t - at_s) * q; };
  }));
}

void CigiWorld::of(const CigiPart& p, std::vector<Command>& commands, const Refuse& refuse) {
  int e = entity(p.entity, refuse);
  if (e >= 0) e = partOf(e, p.part, refuse);
  if (e < 0) return;
  if (!p.enabled) return refuse("a part is to be gone, and every body of the scenario stays in it");
  CigiOffsets& offsets = partOffsets_[e];
  offsets.take(p.offsets);
  commands.push_back(now([=, motion = simulation_.entities[static_cast<std::size_t>(e)].motion, given = offsets](Courses& courses, double at_s) {
    const Pose rest = motion.at(at_s);
    const Pose moved{rest.position + rest.orientation * given.position(), rest.orientation * given.orientation()};
    move(courses, e, at_s, moved.position, std::nullopt);
    courses.orientations[e] = [=](double) { return moved.orientation; };
  }));
}

void CigiWorld::of(const CigiView& v, std::vector<Command>& commands, const Refuse& refuse) {
  for (int c : cameras(v.view, v.group, refuse)) {
    const Camera& camera = simulation_.cameras[static_cast<std::size_t>(c)];
    if (v.entity != camera.mount.carrier + 1) {
      refuse("camera '" + camera.name + "' goes with entity " + std::to_string(camera.mount.carrier + 1) + " in the scenario, not with " +
             std::to_string(v.entity));
      continue;
    }
    CigiOffsets& offsets = viewOffsets_[c];
    offsets.take(v.offsets);
    const glm::dquat axes = camera.mount.carrier >= 0 ? glm::dquat(1.0, 0.0, 0.0, 0.0) : northWestUp();
    const bool moves = offsets.forward_m || offsets.left_m || offsets.up_m, turns = offsets.yaw_rad || offsets.pitch_rad || offsets.roll_rad;
    // A gimbal is demanded to look there.
    const bool gimbal = turns && camera.follower.has_value();
    if (gimbal) {
      try {
        requireTakesCommands(camera, {"CIGI", 0, 0, -1});
      } catch (const UserError& e) {
        refuse(e.what());
        continue;
      }
    }
    commands.push_back(now([=, name = camera.name, mount = camera.mount, given = offsets](Courses& courses, double at_s) {
      const Pose pose{axes * given.position(), axes * given.orientation()};
      if (gimbal) {
        const glm::dvec3 sight = pose.orientation * glm::dvec3(1, 0, 0);
        const bool carried = mount.carrier >= 0;
        addPointing(courses, name, {0, at_s, carried, carried ? glm::conjugate(mount.motion.at(at_s).orientation) * sight : sight});
      }
      if (moves) courses.cameraPositions[name] = [=](double) { return pose.position; };
      if (turns && !gimbal) courses.cameraOrientations[name] = [=](double) { return pose.orientation; };
    }));
  }
}

void CigiWorld::of(const CigiViewDefinition& d, std::vector<Command>& commands, const Refuse& refuse) {
  const std::optional<double> wide_rad = d.horizontalFieldOfView_rad();
  if (!wide_rad) return refuse("a view that is not as wide to the left as to the right, or whose width is not given");
  for (int c : cameras(d.view, d.group, refuse))
    worded({{"command", "look"}, {"camera", simulation_.cameras[static_cast<std::size_t>(c)].name}, {"field_of_view", number(*wide_rad) + " rad"}}, commands,
           refuse);
}

void CigiWorld::of(const CigiSensor& s, std::vector<Command>& commands, const Refuse& refuse) {
  constexpr double kNominal = 0.5, kDecades = 2.0;
  for (int c : cameras(s.view, 0, refuse))
    worded({{"command", "gain"},
            {"camera", simulation_.cameras[static_cast<std::size_t>(c)].name},
            {"factor", number(s.automaticGain ? 1.0 : std::pow(10.0, kDecades * (s.gain - kNominal)))}},
           commands, refuse);
}

void CigiWorld::of(const CigiComponent& c, std::vector<Command>& commands, const Refuse& refuse) {
  const std::optional<double> value = c.asFloat(0);
  if (c.componentClass == CigiComponentClass::Entity) {
    const int e = entity(c.instance, refuse);
    if (e < 0) return;
    const Entity& body = simulation_.entities[static_cast<std::size_t>(e)];
    if (!value) return refuse("a temperature that is no number");
    if (c.component > static_cast<int>(body.surfaces.size()))
      return refuse("component " + std::to_string(c.component) + " of a body of " + std::to_string(body.surfaces.size()) + " parts");
    std::vector<std::pair<std::string, std::string>> words{{"command", "temperature"}, {"entity", body.name}, {"value", number(*value) + " K"}};
    if (c.component > 0) words.emplace_back("part", body.mesh->parts[body.surfaces[static_cast<std::size_t>(c.component - 1)].meshPart].name);
    return worded(words, commands, refuse);
  }
  const bool level = c.component == 1, trigger = c.component == 2, eject = c.component == 3, throttle = c.component == 4;
  if (c.componentClass != CigiComponentClass::System || (!level && !trigger && !eject && !throttle))
    return refuse("component " + std::to_string(c.component) + " of class " + std::to_string(static_cast<int>(c.componentClass)));
  if (eject) {
    if (c.instance < 1 || c.instance > static_cast<int>(simulation_.stores.size()))
      return refuse("flare " + std::to_string(c.instance) + " is none of 1 to " + std::to_string(simulation_.stores.size()) + " that are 'on_command'");
    return worded({{"command", "eject"}, {"flare", simulation_.stores[static_cast<std::size_t>(c.instance - 1)].name}}, commands, refuse);
  }
  if (throttle) {
    std::vector<std::string> plumes;
    for (const FieldBody& field : simulation_.fields)
      if (field.source->hasThrottle()) plumes.push_back(field.name);
    if (c.instance < 1 || c.instance > static_cast<int>(plumes.size()))
      return refuse("plume " + std::to_string(c.instance) + " is none of 1 to " + std::to_string(plumes.size()));
    if (!value) return refuse("a throttle that is no number");
    return worded({{"command", "throttle"}, {"plume", plumes[static_cast<std::size_t>(c.instance - 1)]}, {"value", number(*value)}}, commands, refuse);
  }
  if (c.instance < 1 || c.instance > static_cast<int>(simulation_.lights.size()))
    return refuse("light " + std::to_string(c.instance) + " is none of 1 to " + std::to_string(simulation_.lights.size()));
  const std::string& light = simulation_.lights[static_cast<std::size_t>(c.instance - 1)].name;
  if (trigger) return worded({{"command", "trigger"}, {"light", light}}, commands, refuse);
  if (!value) return refuse("a level that is no number");
  worded({{"command", "light"}, {"light", light}, {"level", number(*value)}}, commands, refuse);
}

}  // namespace pitviper
