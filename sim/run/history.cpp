#include "sim/run/history.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/flight/standard_atmosphere.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/gravity.hpp"

namespace pitviper {
namespace {

constexpr double kDegrees = 180.0 / kPi;
/// Poses that are kept for pictures, of all things together: 60 bytes each.
constexpr std::size_t kMostKept = 400000;
/// Points of a path whose motion is known.
constexpr int kPathPoints = 400;
/// A pose this near to the scenario's is the scenario's: the same sums, rounded.
constexpr double kSamePlace = 1e-9, kSameTurn = 1e-12;

bool isSamePlace(const glm::dvec3& a, const glm::dvec3& b) { return glm::distance(a, b) <= kSamePlace * (1.0 + glm::length(a)); }
bool isSameTurn(const glm::dquat& a, const glm::dquat& b) { return std::abs(glm::dot(a, b)) >= 1.0 - kSameTurn; }

/// What of a frame's header is about its gimbal, as text of cells.
std::string gimbalCells(const Frame& frame);

/// Cells of a line.
class Cells {
 public:
  explicit Cells(std::string& line) : line_(line) {}
  /// Nothing for what is not finite. Twelve digits: a tenth of a millimetre over 10,000 km and more.
  void number(double v, int digits = 12) {
    comma();
    if (!std::isfinite(v)) return;
    char text[40];
    const auto end = std::to_chars(text, text + sizeof text, v == 0.0 ? 0.0 : v, std::chars_format::general, digits).ptr;
    line_.append(text, end);
  }
  void vector(const std::optional<glm::dvec3>& v, double factor = 1.0) {
    for (int i = 0; i < 3; ++i) number(v ? (*v)[i] * factor : NAN);
  }
  /// Names of a scenario hold no commas.
  void text(const std::string& t) {
    comma();
    line_ += t;
  }
  void none(int count) {
    for (int i = 0; i < count; ++i) comma();
  }

 private:
  void comma() {
    if (begun_) line_ += ',';
    begun_ = true;
  }
  std::string& line_;
  bool begun_ = false;
};

constexpr const char* kGimbalHead =
    "azimuth_deg,elevation_deg,azimuth_rate_deg_s,elevation_rate_deg_s,driver,mode,locked,target_right_px,target_down_px,track_error_px";
constexpr int kGimbalCells = 10;

std::string gimbalCells(const Frame& frame) {
  const std::string prefix = "pitviper.gimbal.";
  std::map<std::string_view, const decltype(Attribute::value)*> said;
  for (const Attribute& a : frame.attributes)
    if (a.name.starts_with(prefix)) said.emplace(std::string_view(a.name).substr(prefix.size()), &a.value);
  if (said.empty()) return std::string(static_cast<std::size_t>(kGimbalCells - 1), ',');
  const auto find = [&]<class T>(const char* name, const T*) -> const T* {
    const auto found = said.find(name);
    return found == said.end() ? nullptr : std::get_if<T>(found->second);
  };
  std::string line;
  Cells cells(line);
  const auto two = [&](const char* name, double factor) {
    const auto* v = find(name, static_cast<const std::vector<double>*>(nullptr));
    for (std::size_t i = 0; i < 2; ++i) cells.number(v && v->size() == 2 ? (*v)[i] * factor : NAN);
  };
  const auto word = [&](const char* name) {
    const auto* v = find(name, static_cast<const std::string*>(nullptr));
    cells.text(v ? *v : "");
  };
  two("angles_rad", kDegrees), two("rates_rad_s", kDegrees), word("driver"), word("mode");
  const auto* locked = find("locked", static_cast<const int*>(nullptr));
  cells.text(locked ? std::to_string(*locked) : "");
  two("target_px", 1.0);
  const auto* error = find("track_error_px", static_cast<const double*>(nullptr));
  cells.number(error ? *error : NAN);
  return line;
}

}  // namespace

/// A body, lamp or camera.
struct History::Thing {
  std::string name, kind;
  std::size_t index = 0;  ///< of its kind
  Mover mover;
  const Camera* camera = nullptr;
  bool hasRows = false, isKnown = true;  ///< the second: everywhere so far as the scenario's motion has it
};

struct History::Sample {
  bool isThere = false;
  bool isKnown = false, isPlaceKnown = false;  ///< pose, or position alone, as the scenario's motion has it
  Pose pose;
};

struct History::Tick {
  int frame = 0;
  double time_s = 0.0;
  std::vector<Sample> samples;
  std::map<std::size_t, std::string> gimbals;  ///< cells, by thing
};

bool hasHistory(const Simulation& sim) {
  const auto moves = [](const auto& thing) { return !thing.mount.motion.isStill(); };
  if (std::any_of(sim.entities.begin(), sim.entities.end(), [](const Entity& e) { return !e.motion.isStill(); })) return true;
  if (std::any_of(sim.lights.begin(), sim.lights.end(), moves) || std::any_of(sim.cameras.begin(), sim.cameras.end(), moves)) return true;
  if (std::any_of(sim.cameras.begin(), sim.cameras.end(), [](const Camera& c) { return c.follower.has_value(); })) return true;
  Courses courses;
  for (const Command& c : sim.commands) c.change(courses, c.at_s);
  return !courses.positions.empty() || !courses.orientations.empty() || !courses.cameraPositions.empty() || !courses.cameraOrientations.empty();
}

History::History(const Simulation& simulation, bool keepsPaths) : simulation_(simulation), keepsPaths_(keepsPaths) {
  moving_.frame = simulation.frame;
  moving_.time = simulation.time;
  moving_.entities = simulation.entities;
  moving_.lights = simulation.lights;
  for (std::size_t i = 0; i < moving_.entities.size(); ++i) {
    const Entity& e = moving_.entities[i];
    things_.push_back({e.name, "body", i, Mover(moving_, e.motion, e.parent), nullptr, !e.motion.isStill(), true});
  }
  for (std::size_t i = 0; i < moving_.lights.size(); ++i) {
    const PointLight& l = moving_.lights[i];
    if (l.lamp >= 0) continue;
    things_.push_back({l.name, "light", i, Mover(moving_, l.mount.motion, l.mount.carrier), nullptr, !l.mount.motion.isStill(), true});
  }
  for (std::size_t i = 0; i < simulation.cameras.size(); ++i) {
    const Camera& c = simulation.cameras[i];
    things_.push_back({c.name, "camera", i, Mover(moving_, c.mount.motion, c.mount.carrier), &c, true, true});
  }
}

History::~History() = default;

std::string History::head() {
  std::string head =
      "time_s,frame,name,kind,present,east_m,north_m,up_m,velocity_east_m_s,velocity_north_m_s,velocity_up_m_s,acceleration_east_m_s2,acceleration_north_m_s2,"
      "acceleration_up_m_s2,heading_deg,pitch_deg,roll_deg,roll_rate_deg_s,pitch_rate_deg_s,yaw_rate_deg_s,speed_m_s,mach,height_m,load_g,";
  head += kGimbalHead;
  head += '\n';
  return head;
}

const WorldState& History::scenarios(double time_s) {
  const auto found = worlds_.find(time_s);
  return found != worlds_.end() ? found->second : worlds_.emplace(time_s, advance(moving_, time_s)).first->second;
}

void History::begin(int frame, const WorldState& world) {
  if (open_ && open_->frame == frame) return;
  close();
  worlds_.clear();
  open_ = std::make_unique<Tick>();
  open_->frame = frame;
  open_->time_s = world.time_s;
  open_->samples.resize(things_.size());
  const WorldState& own = scenarios(world.time_s);
  for (std::size_t k = 0; k < things_.size(); ++k) {
    Thing& thing = things_[k];
    Sample& s = open_->samples[k];
    if (thing.camera) continue;
    if (thing.kind == "light") {
      const PointLight& l = moving_.lights[thing.index];
      s.isThere = l.presentAt(world.time_s) && (l.mount.carrier < 0 || world.isThere(static_cast<std::size_t>(l.mount.carrier)));
      s.pose.position = world.lightPoses[thing.index].position;
      s.isKnown = s.isPlaceKnown = isSamePlace(s.pose.position, own.lightPoses[thing.index].position);
    } else {
      s.isThere = world.isThere(thing.index);
      s.pose = world.bodyPose(thing.index);
      s.isPlaceKnown = isSamePlace(s.pose.position, own.bodyPose(thing.index).position);
      s.isKnown = s.isPlaceKnown && isSameTurn(s.pose.orientation, own.entities[thing.index].orientation);
    }
    // What only its carrier has moved has no rows either.
    const int parent = thing.kind == "light" ? moving_.lights[thing.index].mount.carrier : moving_.entities[thing.index].parent;
    const bool carried = parent >= 0 && !open_->samples[static_cast<std::size_t>(parent)].isKnown;
    if (!s.isKnown) thing.isKnown = false, thing.hasRows = thing.hasRows || !carried;
  }
}

void History::look(int frame, const WorldState& world) { begin(frame, world); }

void History::look(const Camera& camera, const Frame& frame, const WorldState& world, const Pose& pose) {
  begin(frame.number, world);
  for (std::size_t k = 0; k < things_.size(); ++k) {
    Thing& thing = things_[k];
    if (!thing.camera || thing.name != camera.name) continue;
    Sample& s = open_->samples[k];
    const Pose own = cameraAt(*thing.camera, scenarios(world.time_s)).pose;
    s.isThere = true;
    s.pose = pose;
    s.isPlaceKnown = isSamePlace(pose.position, own.position);
    s.isKnown = s.isPlaceKnown && !camera.follower && isSameTurn(pose.orientation, own.orientation);
    if (!s.isKnown) thing.isKnown = false;
    open_->gimbals[k] = gimbalCells(frame);
  }
}

void History::close() {
  if (!open_) return;
  last_s_ = open_->time_s;
  if (ticks_ == 0) first_s_ = open_->time_s;
  if (keepsPaths_) keep(*open_);
  ++ticks_;
  if (now_) write(before_.get(), *now_, open_.get());
  before_ = std::move(now_);
  now_ = std::move(open_);
}

void History::keep(const Tick& tick) {
  if (ticks_ % keepEvery_ != 0) return;
  kept_.push_back({tick.frame, tick.time_s, tick.samples, {}});
  if (kept_.size() * std::max<std::size_t>(1, things_.size()) <= kMostKept || kept_.size() < 4) return;
  std::vector<Tick> half;
  for (std::size_t i = 0; i < kept_.size(); i += 2) half.push_back(std::move(kept_[i]));
  kept_ = std::move(half);
  keepEvery_ *= 2;
}

void History::finish() {
  close();
  if (now_) write(before_.get(), *now_, nullptr);
  before_.reset(), now_.reset();
}

std::string History::take() { return std::exchange(lines_, {}); }

void History::write(const Tick* before, const Tick& now, const Tick* after) {
  worlds_.clear();
  for (std::size_t k = 0; k < things_.size(); ++k)
    if (things_[k].hasRows) row(k, before, now, after);
  worlds_.clear();
}

void History::row(std::size_t k, const Tick* before, const Tick& now, const Tick* after) {
  const Thing& thing = things_[k];
  const Sample& s = now.samples[k];
  const double t = now.time_s;
  Cells cells(lines_);
  cells.number(t);
  cells.text(std::to_string(now.frame)), cells.text(thing.name), cells.text(thing.kind), cells.text(s.isThere ? "1" : "0");
  if (!s.isThere) {
    constexpr int kNumbers = 19;
    cells.none(kNumbers + kGimbalCells);
    lines_ += '\n';
    return;
  }
  const auto sampleIn = [&](const Tick* tick) { return tick && tick->samples[k].isThere ? &tick->samples[k] : nullptr; };
  const Sample *last = sampleIn(before), *next = sampleIn(after);
  const auto known = [&](bool Sample::*what) { return s.*what && (!last || last->*what) && (!next || next->*what); };
  std::optional<glm::dvec3> velocity, acceleration, rate;
  if (known(&Sample::isPlaceKnown)) {
    velocity = thing.mover.velocityAt(t);
    acceleration = thing.mover.accelerationAt(t);
  } else if (last && next) {
    const Slopes slopes = slopesThrough(before->time_s, last->pose.position, t, s.pose.position, after->time_s, next->pose.position);
    velocity = slopes.velocity, acceleration = slopes.acceleration;
  }
  const auto orientation = [&](double at_s) {
    return thing.camera ? cameraAt(*thing.camera, scenarios(at_s)).pose.orientation : thing.mover.poseAt(at_s).orientation;
  };
  if (thing.kind != "light" && known(&Sample::isKnown)) rate = thing.mover.rateAt(t, orientation);
  else if (thing.kind != "light" && last && next) rate = turned(last->pose.orientation, next->pose.orientation) / (after->time_s - before->time_s);
  cells.vector(s.pose.position), cells.vector(velocity), cells.vector(acceleration);
  if (thing.kind == "light") cells.none(3);
  else {
    const Attitude a = attitudeOf(s.pose.orientation);
    for (const double angle : {a.heading_rad, a.pitch_rad, a.roll_rad}) cells.number(angle * kDegrees);
  }
  // Right wing down, nose up, nose right; body axes are x forward, y left, z up.
  if (rate) rate = *rate * glm::dvec3(1.0, -1.0, -1.0);
  cells.vector(rate, kDegrees);
  const double height = simulation_.frame.toGeodetic(s.pose.position).height_m;
  cells.number(velocity ? glm::length(*velocity) : NAN);
  cells.number(velocity ? glm::length(*velocity - simulation_.wind_m_s) / standardAir(height).soundSpeed_m_s : NAN);
  cells.number(height);
  // Load factor: the specific force (what an accelerometer feels) across the way, in standard gravities: 1 in level flight, 2 in a level turn banked by 60 deg.
  double load = NAN;
  if (velocity && acceleration && glm::length(*velocity) > 0.0) {
    const glm::dvec3 force = *acceleration - normalGravity(simulation_.frame, s.pose.position), along = glm::normalize(*velocity);
    load = glm::length(force - along * glm::dot(force, along)) / kStandardGravity;
  }
  cells.number(load);
  const auto gimbal = now.gimbals.find(k);
  lines_ += ',';
  lines_ += gimbal != now.gimbals.end() ? gimbal->second : std::string(static_cast<std::size_t>(kGimbalCells - 1), ',');
  lines_ += '\n';
}

std::optional<Pose> History::cameraPoseAt(const std::string& name, double time_s) const {
  const auto found = std::find_if(things_.begin(), things_.end(), [&](const Thing& t) { return t.camera && t.name == name; });
  if (found == things_.end() || kept_.empty()) return std::nullopt;
  if (found->isKnown) return cameraAt(*found->camera, advance(moving_, time_s)).pose;
  const auto nearest =
      std::min_element(kept_.begin(), kept_.end(), [&](const Tick& a, const Tick& b) { return std::abs(a.time_s - time_s) < std::abs(b.time_s - time_s); });
  const Sample& s = nearest->samples[static_cast<std::size_t>(found - things_.begin())];
  return s.isThere ? std::optional(s.pose) : std::nullopt;
}

std::vector<HistoryPath> History::paths() const {
  std::vector<HistoryPath> all;
  for (std::size_t k = 0; k < things_.size(); ++k) {
    const Thing& thing = things_[k];
    if (!thing.hasRows) continue;
    HistoryPath path{thing.name, thing.kind, {}, {}};
    const auto add = [&](double t, const std::optional<Pose>& pose) { path.time_s.push_back(t), path.poses.push_back(pose); };
    if (!thing.isKnown || last_s_ <= first_s_)
      for (const Tick& tick : kept_) add(tick.time_s, tick.samples[k].isThere ? std::optional(tick.samples[k].pose) : std::nullopt);
    else
      for (int i = 0; i <= kPathPoints; ++i) {
        const double t = first_s_ + (last_s_ - first_s_) * i / kPathPoints;
        bool isThere = true;
        if (thing.kind == "body") {
          for (int e = static_cast<int>(thing.index); e >= 0; e = moving_.entities[static_cast<std::size_t>(e)].parent)
            isThere = isThere && moving_.entities[static_cast<std::size_t>(e)].presentAt(t);
        } else if (thing.kind == "light") {
          isThere = moving_.lights[thing.index].presentAt(t);
        }
        add(t, isThere ? std::optional(thing.mover.poseAt(t)) : std::nullopt);
      }
    all.push_back(std::move(path));
  }
  return all;
}

}  // namespace pitviper
