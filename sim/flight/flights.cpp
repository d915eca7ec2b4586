#include "sim/flight/flights.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/flight/flight_axes.hpp"
#include "sim/flight/flight_error.hpp"
#include "sim/scene/gravity.hpp"

namespace pitviper {
namespace {

constexpr double kMostSteps = 1e7, kMostPoints = 1e6;  // minutes of work; 112 MB
constexpr double kNear_steps = 4.0;
constexpr int kNearParts = 16;
constexpr double kStable = 2.7;       // of step x rate; 2.785 is the limit of the formula on the real axis (Hairer and Wanner II, IV.2)
constexpr double kShortest_s = 1e-9;  // pieces below are rounding of times

struct State {
  glm::dvec3 position{0.0}, velocity{0.0}, lateral{0.0};  ///< lateral: lagged, as flown [m/s2]
};

struct Rates {
  glm::dvec3 velocity{0.0}, acceleration{0.0}, lateral{0.0};
  glm::dvec3 ahead{1.0, 0.0, 0.0}, lift{0.0};  ///< through the air; acceleration by lift
  double damping_per_s = 0.0;                  ///< how drag grows with speed
};

State moved(const State& s, const Rates& r, double h) { return {s.position + h * r.velocity, s.velocity + h * r.acceleration, s.lateral + h * r.lateral}; }

bool finite(const State& s) { return std::isfinite(glm::dot(s.position, s.position) + glm::dot(s.velocity, s.velocity) + glm::dot(s.lateral, s.lateral)); }

class Flight {
 public:
  Flight(const FlightTask& task, const FlightWorld& world) : task_(task), world_(world) {
    check();
    if (world.coriolis) rotation_ = earthRotation(world.frame);
    breaks_ = task.body->breaks_s();
    if (task.guidance) breaks_.push_back(task.guidance->begin_s);
    for (double& b : breaks_) b += task.launch.time_s;
    std::sort(breaks_.begin(), breaks_.end());
  }

  FlightResult run() {
    const double steps = std::ceil(task_.duration_s / task_.step_s - 1e-9);  // a duration of whole steps, as rounded
    state_ = {task_.launch.position, task_.launch.velocity, glm::dvec3(0.0)};
    time_s_ = task_.launch.time_s;
    keep(time_s_ + kShortest_s);
    offer();
    for (double k = 1.0; k <= steps && !over_; k += 1.0) {
      const double end = task_.launch.time_s + std::min(k * task_.step_s, task_.duration_s);
      for (double to : piecesUntil(end)) {
        advance(to);
        if (over_) break;
      }
      if (over_ || k == steps || std::fmod(k, task_.keepEvery) == 0.0) keep(time_s_);
    }
    offer();
    return {Trajectory(std::move(points_), task_.before, task_.after), end_, closest_};
  }

 private:
  void check() const {
    if (!task_.body) throw std::invalid_argument("a flight without a body");
    checkWorld(world_);
    const double steps = task_.duration_s / task_.step_s;
    if (!(task_.step_s > 0.0)) throw FlightError("step", std::to_string(task_.step_s), "a time above 0", "1 to 10 ms serve");
    if (!(task_.duration_s > 0.0)) throw FlightError("duration", std::to_string(task_.duration_s), "a time above 0", "say how long it flies at most");
    if (!(steps <= kMostSteps)) throw FlightError("step", std::to_string(steps) + " steps", "at most 10 million", "take longer steps");
    if (task_.keepEvery < 1) throw FlightError("duration", std::to_string(task_.keepEvery), "1 or more", "1 keeps every step");
    if (!(steps / task_.keepEvery <= kMostPoints))
      throw FlightError("duration", std::to_string(steps / task_.keepEvery) + " points", "at most a million", "keep fewer");
    const Launch& l = task_.launch;
    if (!std::isfinite(l.time_s) || !finite({l.position, l.velocity, l.direction})) throw FlightError("launch", "not finite", "finite numbers", "correct it");
    if (!(glm::length(l.direction) > 0.0)) throw FlightError("launch", "no direction", "a vector", "say where it points");
    if (!task_.guidance) return;
    checkGuidance(*task_.guidance);
    if (!task_.target) throw FlightError("guidance", "no target", "one to fly at", "name a target or leave guidance out");
    const double lag = task_.guidance->timeConstant_s;
    if (lag > 0.0 && lag < task_.step_s)
      throw FlightError("time_constant", std::to_string(lag) + " s", "0, or at least the step of " + std::to_string(task_.step_s) + " s",
                        "take shorter steps or no lag");
  }

  Rates rates(double time_s, double within_s, const State& s) const {
    const double t = time_s - task_.launch.time_s, within = within_s - task_.launch.time_s;
    const AirHere air = airIn(world_, s.position);
    const glm::dvec3 flow = s.velocity - air.wind_m_s, gravity = gravityIn(world_, s.position);
    const double speed = glm::length(flow), pressure = 0.5 * air.density_kg_m3 * speed * speed;
    Rates r;
    r.velocity = s.velocity;
    r.ahead = speed > 0.0 ? flow / speed : glm::normalize(task_.launch.direction);
    const double mass = task_.body->mass_kg(t), dragArea = task_.body->dragArea_m2(t, speed / air.soundSpeed_m_s);
    r.acceleration = gravity + coriolisAcceleration(rotation_, s.velocity) + r.ahead * ((task_.body->thrust_N(t, within) - pressure * dragArea) / mass);
    r.damping_per_s = air.density_kg_m3 * speed * dragArea / mass;
    glm::dvec3 command(0.0);
    if (task_.guidance && within >= task_.guidance->begin_s)
      command = guidanceCommand(*task_.guidance, {s.position, s.velocity, {}}, task_.target(time_s), gravity);
    const double lag = task_.guidance ? task_.guidance->timeConstant_s : 0.0;
    if (lag > 0.0) r.lateral = (command - s.lateral) / lag;
    r.lift = lag > 0.0 ? s.lateral : command;
    // What lifts is across the way through the air; a law across the line of sight is flown as it is published, whatever gives it.
    if (!task_.guidance || task_.guidance->law != GuidanceLaw::TrueProportional) r.lift -= r.ahead * glm::dot(r.lift, r.ahead);
    const double size = glm::length(r.lift), most = size > 0.0 ? task_.body->mostLateral_m_s2(t, pressure) : 0.0;
    if (size > most) r.lift *= most / size;
    r.acceleration += r.lift;
    return r;
  }

  /// Runge and Kutta's classical formula (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.1, table 1.2).
  State stepped(const State& s, double from, double to) const {
    const double h = to - from, middle = from + 0.5 * h;
    const Rates a = rates(from, middle, s);
    if (a.damping_per_s * h > kStable)
      throw FlightError("step", "drag stops the body within " + std::to_string(1.0 / a.damping_per_s) + " s, steps are of " + std::to_string(h) + " s",
                        "a stable integration", "take shorter steps; check drag, area and mass");
    const Rates b = rates(middle, middle, moved(s, a, 0.5 * h)), c = rates(middle, middle, moved(s, b, 0.5 * h)), d = rates(to, middle, moved(s, c, h));
    const double w = h / 6.0;
    return {s.position + w * (a.velocity + 2.0 * (b.velocity + c.velocity) + d.velocity),
            s.velocity + w * (a.acceleration + 2.0 * (b.acceleration + c.acceleration) + d.acceleration),
            s.lateral + w * (a.lateral + 2.0 * (b.lateral + c.lateral) + d.lateral)};
  }

  std::vector<double> piecesUntil(double end) const {
    std::vector<double> ends{end};
    if (task_.target) {
      const MovingPoint target = task_.target(time_s_);
      const glm::dvec3 r = target.position - state_.position, v = target.velocity - state_.velocity;
      if (const double closing = -glm::dot(r, v); closing > 0.0 && closing < kNear_steps * task_.step_s * glm::dot(v, v))
        for (int part = 1; part < kNearParts; ++part) ends.push_back(time_s_ + (end - time_s_) * part / kNearParts);
    }
    for (auto b = std::upper_bound(breaks_.begin(), breaks_.end(), time_s_ + kShortest_s); b != breaks_.end() && *b < end - kShortest_s; ++b)
      ends.push_back(*b);
    std::sort(ends.begin(), ends.end());
    return ends;
  }

  void advance(double to) {
    const State next = stepped(state_, time_s_, to);
    if (!finite(next))
      throw FlightError("step", "the flight's numbers overflow " + std::to_string(to - task_.launch.time_s) + " s after launch", "a stable integration",
                        "take shorter steps; check drag, area and mass");
    const double h = to - time_s_;
    double stop = to;
    if (task_.stopAtGround)
      if (const auto into = groundWithin(next, h)) stop = time_s_ + *into, over_ = true, end_ = FlightEnd::Ground;
    if (const auto into = passWithin(next, to)) {
      const double at = time_s_ + *into;
      const State then = stepped(state_, time_s_, at);
      const double distance = glm::length(task_.target(at).position - then.position);
      if (at <= stop) {
        if (!closest_ || distance < closest_->distance_m) closest_ = ClosestApproach{at, distance};
        if (task_.stopAtClosestApproach && distance <= task_.stopWithin_m) stop = at, over_ = true, end_ = FlightEnd::ClosestApproach;
      }
    }
    state_ = over_ ? stepped(state_, time_s_, stop) : next;
    time_s_ = stop;
  }

  std::optional<double> passWithin(const State& next, double to) const {
    if (!task_.target) return std::nullopt;
    const MovingPoint a = task_.target(time_s_), b = task_.target(to);
    return closestInStep(a.position - state_.position, a.velocity - state_.velocity, b.position - next.position, b.velocity - next.velocity, to - time_s_);
  }

  /// Height above ground crosses 0 from above: by the cubic through heights and climb rates at both ends, bisected.
  std::optional<double> groundWithin(const State& next, double h) const {
    const double h0 = heightIn(world_, state_.position) - world_.groundHeight_m, h1 = heightIn(world_, next.position) - world_.groundHeight_m;
    if (!(h0 >= 0.0) || !(h1 < 0.0)) return std::nullopt;
    const double m0 = h * glm::dot(state_.velocity, upIn(world_, state_.position)), m1 = h * glm::dot(next.velocity, upIn(world_, next.position));
    const double dp = h1 - h0 - m0, dv = m1 - m0;
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 52; ++i) {
      const double s = 0.5 * (low + high);
      (h0 + s * (m0 + s * (3.0 * dp - dv + s * (dv - 2.0 * dp))) >= 0.0 ? low : high) = s;
    }
    return low * h;
  }

  void offer() {
    if (!task_.target) return;
    const double distance = glm::length(task_.target(time_s_).position - state_.position);
    if (!closest_ || distance < closest_->distance_m) closest_ = ClosestApproach{time_s_, distance};
  }

  /// `within_s`: which side of a jump its acceleration is of.
  void keep(double within_s) {
    const Rates r = rates(time_s_, within_s, state_);
    TrajectoryPoint p;
    p.time_s = time_s_;
    p.position = state_.position;
    p.velocity = state_.velocity;
    p.acceleration = r.acceleration;
    const glm::dvec3 up = upIn(world_, state_.position);
    const double roll = task_.roll_rad + task_.rollRate_rad_s * (time_s_ - task_.launch.time_s);
    p.orientation = orientationWithTop(r.ahead, task_.stance == Stance::WithLift ? r.lift + 0.1 * kStandardGravity * up : up) *
                    glm::angleAxis(roll, glm::dvec3(1.0, 0.0, 0.0));
    // An end found at the very begin of a step is that point.
    if (!points_.empty() && p.time_s - points_.back().time_s < kShortest_s) {
      if (points_.size() == 1) return;
      points_.pop_back();
    }
    points_.push_back(p);
  }

  const FlightTask& task_;
  const FlightWorld& world_;
  glm::dvec3 rotation_{0.0};
  std::vector<double> breaks_;  ///< in the scenario's time, rising
  State state_;
  double time_s_ = 0.0;
  bool over_ = false;
  FlightEnd end_ = FlightEnd::Duration;
  std::optional<ClosestApproach> closest_;
  std::vector<TrajectoryPoint> points_;
};

}  // namespace

Launch launchFrom(double time_s, const Pose& parent, const glm::dvec3& parentVelocity, const glm::dvec3& offset, const glm::dvec3& ejection) {
  const glm::dvec3 push = parent.orientation * ejection;
  const glm::dvec3 ahead = glm::length(push) > 0.0 ? push : parent.orientation * glm::dvec3(1.0, 0.0, 0.0);
  return {time_s, parent.position + parent.orientation * offset, parentVelocity + push, glm::normalize(ahead)};
}

FlightResult fly(const FlightTask& task, const FlightWorld& world) { return Flight(task, world).run(); }

}  // namespace pitviper
