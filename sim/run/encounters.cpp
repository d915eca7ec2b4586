#include "sim/run/encounters.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/flight/closest_approach.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/run/mover.hpp"

namespace pitviper {
namespace {

/// Steps in which cameras' approaches are looked for: 5 ms, that of flights, and no more of them than take a tenth of a second.
constexpr double kStep_s = 0.005, kMostSteps = 50000.0;

int entityNamed(const Simulation& sim, const std::string& name) {
  const auto found = std::find_if(sim.entities.begin(), sim.entities.end(), [&](const Entity& e) { return e.name == name; });
  return found == sim.entities.end() ? -1 : static_cast<int>(found - sim.entities.begin());
}

Mover moverOf(const Simulation& sim, int entity) {
  const Entity& e = sim.entities[static_cast<std::size_t>(entity)];
  return {sim, e.motion, e.parent};
}

PointMotion pointOf(const Mover& mover) {
  return [&mover](double t) { return MovingPoint{mover.poseAt(t).position, mover.velocityAt(t), {}}; };
}

void describe(Encounter& e, const Mover& body, const Mover& target) {
  const Pose to = target.poseAt(e.time_s);
  e.at = body.poseAt(e.time_s).position, e.targetAt = to.position;
  const glm::dvec3 v = body.velocityAt(e.time_s), other = target.velocityAt(e.time_s), relative = v - other;
  e.speed_m_s = glm::length(v), e.targetSpeed_m_s = glm::length(other), e.relativeSpeed_m_s = glm::length(relative);
  e.aspect_rad = NAN;
  if (e.relativeSpeed_m_s > 0.0)
    e.aspect_rad = std::acos(std::clamp(glm::dot(to.orientation * glm::dvec3(1, 0, 0), -relative) / e.relativeSpeed_m_s, -1.0, 1.0));
}

/// Both there, as far as they say.
std::pair<double, double> bothThere(const Simulation& sim, int body, int target, double begin, double end) {
  for (const int e : {body, target}) {
    if (e < 0) continue;
    const Lifetime life = lifetimeOf(sim, e);
    begin = std::max(begin, life.begin_s), end = std::min(end, life.end_s);
  }
  return {begin, end};
}

std::optional<Encounter> search(const Mover& body, const Mover& target, double begin, double end) {
  if (!(end > begin)) return std::nullopt;
  const ClosestApproach nearest = closestApproach(pointOf(body), pointOf(target), begin, end, std::max(kStep_s, (end - begin) / kMostSteps));
  Encounter e;
  e.time_s = nearest.time_s, e.distance_m = nearest.distance_m;
  e.passed = nearest.time_s > begin && nearest.time_s < end;
  describe(e, body, target);
  return e;
}

}  // namespace

std::vector<Encounter> encountersOf(const Simulation& sim, double begin_s, double end_s) {
  std::vector<Encounter> all;
  for (std::size_t i = 0; i < sim.entities.size(); ++i) {
    const Entity& body = sim.entities[i];
    if (!body.flight || body.flight->target.empty()) continue;
    const int target = entityNamed(sim, body.flight->target);
    if (target < 0) continue;
    const Mover own = moverOf(sim, static_cast<int>(i)), other = moverOf(sim, target);
    const Trajectory& way = body.flight->trajectory;
    std::optional<Encounter> e;
    if (body.flight->closest) {
      e.emplace();
      // Its last point's time may be a rounding away.
      e->time_s = std::clamp(body.flight->closest->time_s, way.begin_s(), way.end_s()), e->distance_m = body.flight->closest->distance_m;
      e->passed = body.flight->end == "closest approach" || (e->time_s > way.begin_s() && e->time_s < way.end_s());
      describe(*e, own, other);
    } else {
      const auto [begin, end] = bothThere(sim, static_cast<int>(i), target, way.begin_s(), way.end_s());
      e = search(own, other, begin, end);
    }
    if (!e) continue;
    e->body = body.name, e->target = body.flight->target, e->kind = "flight", e->end = body.flight->end;
    all.push_back(*e);
  }
  for (const Camera& c : sim.cameras) {
    const int target = c.mount.lookAtEntity, carrier = c.mount.carrier;
    if (target < 0 || target == carrier) continue;
    const Entity& seen = sim.entities[static_cast<std::size_t>(target)];
    if (carrier >= 0) {
      const Entity& body = sim.entities[static_cast<std::size_t>(carrier)];
      if (body.flight && body.flight->target == seen.name) continue;
    }
    const Mover own(sim, c.mount.motion, carrier), other = moverOf(sim, target);
    const auto stands = [&](const Mover& m, int parent) { return !m.movesItself() && parent < 0; };
    if (stands(own, carrier) && stands(other, seen.parent)) continue;
    const auto [begin, end] = bothThere(sim, -1, target, begin_s, end_s);
    std::optional<Encounter> e = search(own, other, begin, end);
    if (!e) continue;
    e->body = c.name, e->target = seen.name, e->kind = "camera";
    // A camera does not come from anywhere: what counts is the side that it sees.
    const glm::dvec3 nose = other.poseAt(e->time_s).orientation * glm::dvec3(1, 0, 0), sight = e->at - e->targetAt;
    e->aspect_rad = glm::length(sight) > 0.0 ? std::acos(std::clamp(glm::dot(nose, glm::normalize(sight)), -1.0, 1.0)) : NAN;
    all.push_back(*e);
  }
  return all;
}

std::string encountersText(const std::vector<Encounter>& encounters) {
  std::string text =
      "body,target,kind,time_s,distance_m,passed,relative_speed_m_s,aspect_deg,speed_m_s,target_speed_m_s,east_m,north_m,up_m,target_east_m,target_north_m,"
      "target_up_m,end\n";
  for (const Encounter& e : encounters) {
    text += e.body + "," + e.target + "," + e.kind;
    const auto number = [&](double v) { text += std::isfinite(v) ? print(",%.12g", v) : ","; };
    number(e.time_s), number(e.distance_m);
    text += e.passed ? ",1" : ",0";
    number(e.relativeSpeed_m_s), number(e.aspect_rad * 180.0 / kPi), number(e.speed_m_s), number(e.targetSpeed_m_s);
    for (const glm::dvec3& p : {e.at, e.targetAt})
      for (int i = 0; i < 3; ++i) number(p[i]);
    text += "," + e.end + "\n";
  }
  return text;
}

}  // namespace pitviper
