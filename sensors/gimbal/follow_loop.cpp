#include "sensors/gimbal/follow_loop.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

// What is to act from a tick on, but for the rounding of sums of times, does not act at it: 0.5 us, far below what a servo takes notice of.
constexpr double kSame_s = 1e-3 * kServoStep_s;

}  // namespace

FollowLoop::FollowLoop(const FollowOptions& options)
    : options_(options), jitter_(options.gimbal.jitter, options.seed, options.camera), tracker_(options.tracker) {
  requireSound(options.gimbal);
  if (!(options.latency_s >= 0.0) || !std::isfinite(options.latency_s)) throw std::invalid_argument("gimbal: a latency that is negative or no number");
  if (options.driver == GimbalDriver::Poses) throw std::invalid_argument("gimbal: a replay without a record");
}

FollowLoop::FollowLoop(const FollowOptions& options, const PoseRecord& record) : options_(options), replay_(&record) { options_.driver = GimbalDriver::Poses; }

glm::dvec2 FollowLoop::anglesAt(const Line& line, const Pose& carrier) const {
  return anglesOf(line.inCarrier ? line.direction : glm::conjugate(carrier.orientation) * line.direction);
}

glm::dvec2 FollowLoop::demandOfLine(const Line& line, const glm::dvec2& angles, double time_s) const {
  glm::dvec2 offset = line.isAim ? options_.gimbal.offset_rad : glm::dvec2(0.0);
  if (options_.gimbal.scan.by == Scan::By::Gimbal) offset += scanAt(options_.gimbal.scan, time_s);
  return turned(angles, offset);
}

glm::dvec2 FollowLoop::demandAtStart(const FollowTick& first) const {
  const auto angles = first.target ? demandOf(first.carrier, first.cameraPosition, *first.target) : std::nullopt;
  if (!angles) return glm::dvec2(0.0);
  return turned(*angles, options_.gimbal.offset_rad);
}

/// As the gimbal's angles say: what it knows of the camera's axes.
glm::dquat FollowLoop::believed(const FollowTick& at, const glm::dvec2& angle) const {
  const Scan& scan = options_.gimbal.scan;
  const glm::dvec2 mirror = scan.by == Scan::By::Optics ? scanAt(scan, at.time_s) : glm::dvec2(0.0);
  return at.carrier.orientation * orientationOf(angle) * orientationOf(mirror, options_.gimbal.roll_rad);
}

/// As they are.
glm::dquat FollowLoop::sight(const FollowTick& at, const glm::dvec2& angle) const {
  const Scan& scan = options_.gimbal.scan;
  glm::dvec2 off = options_.gimbal.boresight_rad + jitter_.at(at.time_s);
  if (scan.by == Scan::By::Optics) off += scanAt(scan, at.time_s);
  return glm::normalize(at.carrier.orientation * orientationOf(angle) * orientationOf(off, options_.gimbal.roll_rad));
}

/// Along a line that was one direction at the last tick and is another now: its angles go evenly between.
void FollowLoop::follow(Course& course, const FollowTick& now, const Line& was, const Line& is, double until_s) const {
  const glm::dvec2 before = anglesAt(was, course.last.carrier);
  glm::dvec2 after = anglesAt(is, now.carrier);
  after.x += 2.0 * kPi * std::round((before.x - after.x) / (2.0 * kPi));
  const double from_s = course.last.time_s, span_s = now.time_s - from_s;
  const auto demanded = [&](double t_s) { return demandOfLine(is, before + (after - before) * ((t_s - from_s) / span_s), t_s); };
  course.gimbal = step(options_.gimbal, course.gimbal, demanded, until_s);
}

bool FollowLoop::knowsWhere(const FollowTick& now) const { return now.target && glm::length(*now.target - now.cameraPosition) > 0.0; }

void FollowLoop::begin(const FollowTick& first) {
  const bool aims = knowsWhere(first);
  course_.last = first;
  course_.lines.clear();
  demandAlong(aims ? *first.target - first.cameraPosition : first.carrier.orientation * glm::dvec3(1, 0, 0), first.time_s, aims);
  const Line& line = course_.lines.front();
  course_.gimbal.time_s = first.time_s;
  course_.gimbal.angle_rad = withinLimits(options_.gimbal.limits, demandOfLine(line, anglesAt(line, first.carrier), first.time_s));
}

void FollowLoop::advance(Course& course, const FollowTick& now) const {
  std::vector<Line>& lines = course.lines;
  if (options_.driver == GimbalDriver::Truth && knowsWhere(now)) {
    const Line is{now.time_s, *now.target - now.cameraPosition, false, true};
    follow(course, now, lines.front(), is, now.time_s);
    lines = {is};
  } else {
    for (; lines.size() > 1 && lines[1].from_s < now.time_s - kSame_s; lines.erase(lines.begin()))
      follow(course, now, lines[0], lines[0], std::max(lines[1].from_s, course.gimbal.time_s));
    follow(course, now, lines[0], lines[0], now.time_s);
  }
  course.last = now;
}

PoseRow FollowLoop::tick(const FollowTick& now) {
  if (row_ && !(now.time_s > course_.last.time_s)) throw std::invalid_argument("gimbal: ticks that do not rise");
  PoseRow row;
  if (replay_ != nullptr) {
    row = replay_->ofFrame(now.frame);
    row.driver = GimbalDriver::Poses;
    course_.last = now;
    row_ = row;
    record_.push_back(row);
    return row;
  }
  if (!row_) {
    begin(now);
  } else {
    before_ = course_;
    advance(course_, now);
  }
  const glm::dvec2 angle = course_.gimbal.angle_rad;
  row.time_s = now.time_s;
  row.frame = now.frame;
  row.pose = {now.cameraPosition, sight(now, angle)};
  row.angle_rad = angle;
  row.driver = options_.driver;
  if (options_.driver == GimbalDriver::Centroid) {
    row.locked = tracker_.locked();
    if (seen_)
      if (const auto at = filmOf(filmAt(now), glm::conjugate(believed(now, angle)) * *seen_)) tracker_.expectAt(*at);
  } else {
    const Line& line = course_.lines.front();
    glm::dvec2 demanded = demandOfLine(line, anglesAt(line, now.carrier), now.time_s);
    demanded.x = azimuthNear(options_.gimbal.limits, demanded.x, angle.x);
    row.locked = beyondLimits(options_.gimbal.limits, demanded) == glm::dvec2(0.0);
  }
  row_ = row;
  record_.push_back(row);
  return row;
}

Pinhole FollowLoop::filmAt(const FollowTick& at) const {
  Pinhole film = options_.film;
  if (at.focalLength_m > 0.0) film.focalLength_m = at.focalLength_m;
  return film;
}

Pose FollowLoop::replayedAt(double time_s) const {
  const std::vector<PoseRow>& rows = replay_->rows;
  const auto after = std::lower_bound(rows.begin(), rows.end(), time_s, [](const PoseRow& row, double t) { return row.time_s < t; });
  if (after == rows.begin()) return rows.front().pose;
  if (after == rows.end()) return rows.back().pose;
  if (after->time_s == time_s) return after->pose;
  const PoseRow& before = *(after - 1);
  const double share = (time_s - before.time_s) / (after->time_s - before.time_s);
  return {glm::mix(before.pose.position, after->pose.position, share), glm::normalize(glm::slerp(before.pose.orientation, after->pose.orientation, share))};
}

Pose FollowLoop::during(const FollowTick& then) const {
  if (!row_) throw std::invalid_argument("gimbal: a time before there was a tick");
  if (then.time_s == course_.last.time_s) return row_->pose;
  if (replay_ != nullptr) return replayedAt(then.time_s);
  const bool isBefore = then.time_s < course_.last.time_s;
  Course course = isBefore && before_ ? *before_ : course_;
  // An exposure that began before the last tick but one is longer than a frame: what it saw of that time is told as of its end.
  if (then.time_s > course.last.time_s) advance(course, then);
  return {then.cameraPosition, sight(then, course.gimbal.angle_rad)};
}

void FollowLoop::demand(const Line& line) {
  // What was to come later than this gives way to it.
  std::vector<Line>& lines = course_.lines;
  while (lines.size() > 1 && lines.back().from_s >= line.from_s) lines.pop_back();
  lines.push_back(line);
}

void FollowLoop::demandAlong(const glm::dvec3& direction, double from_s, bool isAim) {
  if (options_.gimbal.stabilised) demand({from_s, direction, false, isAim});
  else demand({from_s, glm::conjugate(course_.last.carrier.orientation) * direction, true, isAim});
}

Centroid FollowLoop::look(std::span<const float> picture) {
  if (!row_) throw std::invalid_argument("gimbal: a picture before the first tick");
  const Centroid c = tracker_.look(picture, options_.film.width, options_.film.height);
  if (!c.found) return c;
  seen_ = believed(course_.last, course_.gimbal.angle_rad) * directionOfFilm(filmAt(course_.last), c.at_px);
  demandAlong(*seen_, course_.last.time_s + options_.latency_s, true);
  return c;
}

void FollowLoop::command(const glm::dvec2& angles, double from_s) {
  if (!std::isfinite(angles.x) || !std::isfinite(angles.y)) throw std::invalid_argument("gimbal: a command that is no direction");
  if (!row_) throw std::invalid_argument("gimbal: a command before the first tick");
  demand({std::max(course_.last.time_s, from_s), directionOf(angles), true, false});
}

void FollowLoop::commandAlong(const glm::dvec3& direction, double from_s) {
  const double length = glm::length(direction);
  if (!(length > 0.0) || !std::isfinite(length)) throw std::invalid_argument("gimbal: a command that is no direction");
  if (!row_) throw std::invalid_argument("gimbal: a command before the first tick");
  demandAlong(direction, std::max(course_.last.time_s, from_s), false);
}

}  // namespace pitviper
