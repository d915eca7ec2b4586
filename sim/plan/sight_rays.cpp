#include "sim/plan/sight_rays.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/radiometry/constants.hpp"
#include "sim/world/field_states.hpp"
#include "sim/world/glint.hpp"
#include "sim/world/ground.hpp"

namespace pitviper {
namespace {

/// Lines that a survey of the film casts, evenly and aimed at bodies: what shows on a thousandth of it is met with 95 %.
constexpr int kSurvey = 3000, kAimedSurvey = 600;
/// Where in a subpixel its line goes through: not its very middle, where lines of a symmetrical scene run along edges of meshes and miss both sides.
constexpr double kInColumn = 0.4871, kInRow = 0.5113;
/// Frames whose states are kept, and those that are looked at where there are fields.
constexpr size_t kMostStates = 256;
constexpr int kFieldFrames = 96;
/// How often something is drawn by chance until it is in view.
constexpr int kTries = 24;
/// Frames at which bodies and lamps are looked for at their nearest and farthest.
constexpr int kMostFrames = 400;
/// Frames at which lamps are looked for because their levels bend, at most.
constexpr size_t kMostLevels = 64;
/// Only so many combinations of things, the most frequent, have extremes of their own.
constexpr size_t kMostExtremes = 40;
/// Frames in which small bodies are looked for, the first and the last among them.
constexpr int kSmallFrames = 12;
/// Steps towards a glint, each shorter than the last.
constexpr int kGlintSteps = 40;
constexpr double kShorter = 0.87;
/// Lamps whose glints are looked for.
constexpr size_t kGlintLamps = 8;
/// Nothing is lower than this [m].
constexpr double kGround_m = -100.0;

const FollowerChoice* followerOf(const Eye& eye) { return eye.camera && eye.camera->follower ? &*eye.camera->follower : nullptr; }

}  // namespace

SightRays::SightRays(const Simulation& simulation, const Eye& eye, unsigned long long seed)
    : simulation_(simulation), eye_(eye), dice_(seed), drawn_(simulation.entities.size(), 1) {
  if (eye.camera && eye.camera->mount.carrier >= 0) drawn_[static_cast<size_t>(eye.camera->mount.carrier)] = 0;
  findLifetimes();
  for (size_t e = 0; e < simulation.entities.size(); ++e)
    for (size_t s = 0; drawn_[e] && s < simulation.entities[e].surfaces.size(); ++s) surfaces_.emplace_back(e, s);
}

void SightRays::findLifetimes() {
  const TimeAxis& time = simulation_.time;
  const double last = time.frames - 1;
  for (size_t e = 0; e < simulation_.entities.size(); ++e) {
    const Lifetime l = lifetimeOf(simulation_, static_cast<int>(e));
    // A frame's time within it, or the nearest before.
    const auto frame = [&](double t) { return static_cast<int>(std::clamp(std::floor((t - time.start_s) / time.step_s + kSameTick), -1.0, last + 1.0)); };
    lifetimes_.emplace_back(std::max(frame(l.begin_s), 0), std::min(frame(l.end_s), time.frames - 1));
  }
}

/// A random one of those in which a surface may be there.
int SightRays::frameWith(size_t surface) {
  const auto [first, last] = lifetimes_[surfaces_[surface].first];
  return last < first ? std::min(first, simulation_.time.frames - 1) : first + static_cast<int>(dice_.below(static_cast<size_t>(last - first) + 1));
}

std::shared_ptr<const WorldState> SightRays::stateAt(int frame) {
  if (const auto known = states_.find(frame); known != states_.end()) return known->second;
  if (states_.size() >= kMostStates) states_.clear();
  const double time_s = simulation_.time.at(frame);
  // What commands may eject burns at every second frame.
  const bool ejected = !simulation_.stores.empty() && frame % 2 == 0;
  return states_[frame] = std::make_shared<const WorldState>(ejected ? withEjected(simulation_, time_s, frame / 2) : advance(simulation_, time_s));
}

/// Any; where there are fields, which take time to work out, one of so many as are kept.
int SightRays::someFrame() {
  const int frames = simulation_.time.frames, frame = static_cast<int>(dice_.below(static_cast<size_t>(frames)));
  if (simulation_.fields.empty() || frames <= kFieldFrames) return frame;
  return static_cast<int>(static_cast<long long>(frame) * kFieldFrames / frames) * (frames - 1) / (kFieldFrames - 1);
}

void SightRays::cast(SightRay& ray) const {
  ray.line.hits = castRay(simulation_, *ray.state, ray.line.origin, ray.line.direction, ray.nearest_m, &drawn_, false, kPlannedFieldSteps);
}

/// Of a camera that a gimbal points: half where its mount looks, half anywhere in the gimbal's field.
SightRay SightRays::startAt(int frame) {
  SightRay ray;
  ray.state = stateAt(frame);
  if (const FollowerChoice* follower = followerOf(eye_); follower && dice_.unit() < 0.5) {
    const double across = dice_.unit(), up = dice_.unit();
    point(ray, follower->anywhere(followerTick(*eye_.camera, *ray.state, frame), {across, up}));
  }
  if (!eye_.camera) {
    ray.line.origin = eye_.probe->position;
    ray.pixel_sr = 4.0 / (static_cast<double>(eye_.probe->resolution) * eye_.probe->resolution);
    return ray;
  }
  const CameraState at = cameraAt(*eye_.camera, *ray.state);
  const double across = static_cast<double>(eye_.camera->samples) * at.pinhole.focalLength_m;
  ray.line.origin = at.pose.position;
  ray.pixel_sr = at.pinhole.pitchX_m * at.pinhole.pitchY_m / (across * across);
  ray.nearest_m = eye_.camera->near_m;
  return ray;
}

void SightRays::point(SightRay& ray, const Pose& pose) const { ray.state = std::make_shared<const WorldState>(pointed(*ray.state, *eye_.camera, pose)); }

/// So that the camera sees a line somewhere on its film, if its gimbal can.
bool SightRays::turnToward(SightRay& ray, int frame, const glm::dvec3& line) {
  const FollowerChoice* follower = followerOf(eye_);
  if (!follower) return false;
  const FollowerTick tick = followerTick(*eye_.camera, *ray.state, frame);
  const auto onAxis = follower->toward(tick, line);
  if (!onAxis) return false;
  const Pinhole p = cameraAt(*eye_.camera, *ray.state).pinhole;
  const double right = p.tanX(dice_.unit() * p.width), up = p.tanY(dice_.unit() * p.height);
  const auto aside = follower->toward(tick, onAxis->orientation * glm::dvec3(1.0, right, -up));
  point(ray, aside ? *aside : *onAxis);
  return inView(ray, line);
}

SightRay SightRays::cameraRay(int frame, size_t column, size_t row) {
  SightRay ray = startAt(frame);
  const CameraState at = cameraAt(*eye_.camera, *ray.state);
  const Pinhole& p = at.pinhole;
  const double samples = eye_.camera->samples;
  const glm::dvec3 film(p.tanX((static_cast<double>(column) + kInColumn) / samples), p.tanY((static_cast<double>(row) + kInRow) / samples), -1.0);
  ray.line.direction = glm::normalize(localFromCamera(at.pose) * film);
  ray.nearest_m *= glm::length(film);
  cast(ray);
  return ray;
}

SightRay SightRays::probeRay(int frame) {
  SightRay ray = startAt(frame);
  const double z = dice_.unit(), phi = 2.0 * kPi * dice_.unit(), r = std::sqrt(1.0 - z * z);
  const glm::dvec3 n = glm::normalize(eye_.probe->normal), helper = std::abs(n.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(helper, n)), y = glm::cross(n, x);
  ray.line.direction = r * std::cos(phi) * x + r * std::sin(phi) * y + z * n;
  cast(ray);
  return ray;
}

SightRay SightRays::filmRay(int frame) {
  if (!eye_.camera) return probeRay(frame);
  const auto samples = static_cast<size_t>(eye_.camera->samples);
  const size_t column = dice_.below(static_cast<size_t>(eye_.camera->pinhole.width) * samples);
  return cameraRay(frame, column, dice_.below(static_cast<size_t>(eye_.camera->pinhole.height) * samples));
}

SightRay SightRays::through(const FilmPlace& place) {
  SightRay ray = startAt(place.frame);
  if (place.pose) point(ray, *place.pose);
  const CameraState at = cameraAt(*eye_.camera, *ray.state);
  const Pinhole& p = at.pinhole;
  const double n = eye_.camera->samples;
  const glm::dvec3 film(p.tanX(place.column + (kInColumn - 0.5) / n), p.tanY(place.row + (kInRow - 0.5) / n), -1.0);
  ray.line.direction = glm::normalize(localFromCamera(at.pose) * film);
  ray.nearest_m *= glm::length(film);
  ray.fromFilm = false;
  cast(ray);
  return ray;
}

SightRay SightRays::fromFilm() { return filmRay(someFrame()); }

std::vector<SightRay> SightRays::overFilm(int count, std::optional<int> only) {
  std::vector<SightRay> lines;
  if (!eye_.camera) {
    for (int n = 0; n < count; ++n) lines.push_back(only ? filmRay(*only) : fromFilm());
    return lines;
  }
  const auto samples = static_cast<size_t>(eye_.camera->samples);
  const size_t columns = static_cast<size_t>(eye_.camera->pinhole.width) * samples, rows = static_cast<size_t>(eye_.camera->pinhole.height) * samples;
  const double each = static_cast<double>(columns * rows), all = each * (only ? 1 : simulation_.time.frames);
  // With fewer subpixels than lines each is drawn as often as any other, or once more.
  for (int n = 0; n < count; ++n) {
    const double at = std::min((n + dice_.unit()) * all / count, all - 1.0);
    const auto frame = static_cast<int>(at / each);
    const auto place = static_cast<size_t>(at - frame * each);
    lines.push_back(cameraRay(only.value_or(frame), place % columns, place / columns));
  }
  return lines;
}

glm::dvec3 SightRays::placeOn(const WorldState& state, size_t surface) {
  const auto [e, s] = surfaces_[surface];
  const Entity& entity = simulation_.entities[e];
  const Mesh& mesh = *entity.mesh;
  const MeshPart& part = mesh.parts[entity.surfaces[s].meshPart];
  glm::dvec3 place(entity.boundingCentre);
  if (part.triangleCount > 0) {
    const glm::uvec3 t = mesh.triangles[part.firstTriangle + dice_.below(part.triangleCount)];
    double a = dice_.unit(), b = dice_.unit();
    if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
    place = (1.0 - a - b) * glm::dvec3(mesh.positions[t.x]) + a * glm::dvec3(mesh.positions[t.y]) + b * glm::dvec3(mesh.positions[t.z]);
    // Inside a body of gas too, not its hull alone.
    if (simulation_.mediumOf(entity)) place = glm::mix(glm::dvec3(entity.boundingCentre), place, dice_.unit());
  }
  return state.entities[e].position + state.entities[e].orientation * place;
}

bool SightRays::inView(const SightRay& ray, const glm::dvec3& direction) const {
  if (eye_.probe) return glm::dot(direction, eye_.probe->normal) > 0.0;
  const CameraState at = cameraAt(*eye_.camera, *ray.state);
  const Pinhole& p = at.pinhole;
  const glm::dvec3 d = glm::transpose(localFromCamera(at.pose)) * direction;
  return glm::length(direction) > ray.nearest_m && d.z < 0.0 && std::abs(d.x) <= -d.z * p.tanX(p.width) && std::abs(d.y) <= -d.z * p.tanY(0);
}

std::optional<SightRay> SightRays::aimedAt(int frame, size_t surface, bool withinLimits) {
  SightRay ray = startAt(frame);
  ray.fromFilm = false;
  if (!ray.state->isThere(surfaces_[surface].first)) return {};
  const glm::dvec3 line = placeOn(*ray.state, surface) - ray.line.origin;
  if (!(glm::length(line) > 0.0) || (!inView(ray, line) && !turnToward(ray, frame, line))) return {};
  ray.line.direction = glm::normalize(line);
  if (withinLimits && simulation_.limits.any() && dice_.unit() < 0.5) stretch(ray, glm::length(line));
  cast(ray);
  return ray;
}

/// Through a random place of a field, in view at a frame.
std::optional<SightRay> SightRays::aimedAtField(int frame, size_t number) {
  SightRay ray = startAt(frame);
  ray.fromFilm = false;
  const FieldState* field = fieldOf(*ray.state, number);
  if (!field || field->elements.empty()) return {};
  const FieldElement& e = field->elements[dice_.below(field->elements.size())];
  const glm::dvec3 off(2.0 * dice_.unit() - 1.0, 2.0 * dice_.unit() - 1.0, 2.0 * dice_.unit() - 1.0);
  const glm::dvec3 place = field->origin + field->localFromField * glm::clamp(e.centre + 0.7 * e.radius_m * off, field->low, field->high);
  const glm::dvec3 line = place - ray.line.origin;
  if (!(glm::length(line) > 0.0) || (!inView(ray, line) && !turnToward(ray, frame, line))) return {};
  ray.line.direction = glm::normalize(line);
  cast(ray);
  return ray.line.hits.slabs.empty() ? std::nullopt : std::optional(std::move(ray));
}

SightRay SightRays::aimed() {
  // A field is as much as a body.
  const size_t things = surfaces_.size() + simulation_.fields.size();
  for (int tries = 0; tries < kTries && !simulation_.fields.empty(); ++tries) {
    const size_t thing = dice_.below(things);
    if (thing < surfaces_.size()) break;
    if (auto ray = aimedAtField(someFrame(), thing - surfaces_.size())) return *ray;
  }
  for (int tries = 0; tries < kTries && !surfaces_.empty(); ++tries) {
    const size_t surface = dice_.below(surfaces_.size());
    if (auto ray = aimedAt(frameWith(surface), surface)) return *ray;
  }
  return fromFilm();
}

bool SightRays::isSmall(const SightRay& ray, const Entity& entity, const Pose& pose) const {
  const CameraState at = cameraAt(*eye_.camera, *ray.state);
  const Pinhole& p = at.pinhole;
  const glm::dvec3 to = pose.position + pose.orientation * glm::dvec3(entity.boundingCentre) - ray.line.origin;
  const double depth = -(glm::transpose(localFromCamera(at.pose)) * to).z, radius = entity.boundingRadius_m;
  return depth > 4.0 * radius + eye_.camera->near_m && 2.0 * radius / depth < eye_.camera->smallBody_px * std::min(p.pitchX_m, p.pitchY_m) / p.focalLength_m;
}

std::vector<SightRay> SightRays::ofSmallBodies(int count) {
  std::vector<SightRay> lines;
  if (!eye_.camera || surfaces_.empty()) return lines;
  const int last = simulation_.time.frames - 1, frames = std::min(simulation_.time.frames, kSmallFrames);
  for (int k = 0; k < frames; ++k) {
    const int frame = k == 0 ? 0 : k == 1 ? last : someFrame();
    const SightRay start = startAt(frame);
    std::vector<size_t> small;
    for (size_t s = 0; s < surfaces_.size(); ++s)
      if (start.state->isThere(surfaces_[s].first) && isSmall(start, simulation_.entities[surfaces_[s].first], start.state->entities[surfaces_[s].first]))
        small.push_back(s);
    for (int n = 0; !small.empty() && n < count / frames; ++n)
      for (int tries = 0; tries < kTries; ++tries)
        if (auto ray = aimedAt(frame, small[dice_.below(small.size())], false)) {
          lines.push_back(std::move(*ray));
          break;
        }
  }
  return lines;
}

/// To some place within the scenario's limits.
void SightRays::stretch(SightRay& ray, double distance_m) {
  const Limits& limits = simulation_.limits;
  auto state = std::make_shared<WorldState>(*ray.state);
  if (limits.farthest_m > 0.0) {
    const double nearest = std::max(limits.nearest_m, std::max(ray.nearest_m, 0.1));
    const double range = nearest * std::pow(std::max(limits.farthest_m / nearest, 1.0), dice_.unit());
    // What is aimed at comes nearer or goes away with all that is around it, or the eye does; neither to under the ground.
    const glm::dvec3 away = (range - distance_m) * ray.line.direction, aim = ray.line.origin + distance_m * ray.line.direction;
    const bool eyeCan = simulation_.frame.height(ray.line.origin - away) > kGround_m, aimCan = simulation_.frame.height(aim + away) > kGround_m;
    if (eyeCan && (!aimCan || dice_.unit() < 0.5)) {
      ray.line.origin -= away;
    } else if (aimCan) {
      for (Pose& pose : state->entities) pose.position += away;
      for (glm::dvec3& light : state->lights) light += away;
    }
  }
  if (limits.hottest_K > 0.0) ray.line.temperature_K = limits.coldest_K + (limits.hottest_K - limits.coldest_K) * dice_.unit();
  if (limits.lightLevel > 0.0)
    for (double& level : state->lightLevels) level = limits.lightLevel * dice_.unit();
  ray.state = std::move(state);
}

SightRays::Candidate SightRays::candidate(SightRay ray) const {
  Candidate c{std::move(ray), {}};
  const RayHits& hits = c.ray.line.hits;
  c.things.emplace_back(hits.solid.entity, hits.solid.surface);
  for (const Hit& h : hits.layers) c.things.emplace_back(h.entity, h.surface);
  for (const Stretch& s : hits.stretches) c.things.emplace_back(s.entity, -1);
  for (size_t k = 0; k < hits.slabs.size(); ++k)
    if (k == 0 || hits.slabs[k].field != hits.slabs[k - 1].field) c.things.emplace_back(-2 - hits.slabs[k].field, -1);
  std::sort(c.things.begin() + 1, c.things.end());
  return c;
}

/// The first that is not before a time.
int SightRays::frameOf(double time_s) const {
  const double frame = std::ceil((time_s - simulation_.time.start_s) / simulation_.time.step_s - kSameTick);
  return static_cast<int>(std::clamp(frame, 0.0, static_cast<double>(simulation_.time.frames - 1)));
}

void SightRays::survey() {
  if (!candidates_.empty()) return;
  const int last = simulation_.time.frames - 1;
  for (int n = 0; n < kSurvey; ++n) {
    // The first and the last frame count for as much as a tenth of all, and so do those in which a command begins to hold.
    const int frame = n % 20 == 0                                    ? 0
                      : n % 20 == 10                                 ? last
                      : n % 10 == 5 && !simulation_.commands.empty() ? frameOf(simulation_.commands[dice_.below(simulation_.commands.size())].at_s)
                                                                     : someFrame();
    candidates_.push_back(candidate(filmRay(frame)));
  }
  for (int n = 0; n < kAimedSurvey && !surfaces_.empty(); ++n)
    if (auto ray = aimedAt(frameWith(static_cast<size_t>(n) % surfaces_.size()), static_cast<size_t>(n) % surfaces_.size()))
      candidates_.push_back(candidate(std::move(*ray)));
  for (size_t n = 0; n < static_cast<size_t>(kAimedSurvey) && !simulation_.fields.empty(); ++n)
    if (auto ray = aimedAtField(someFrame(), n % simulation_.fields.size())) candidates_.push_back(candidate(std::move(*ray)));
  std::map<std::vector<std::pair<int, int>>, size_t> placeOf;
  for (size_t c = 0; c < candidates_.size(); ++c) {
    const auto [at, isNew] = placeOf.try_emplace(candidates_[c].things, combinations_.size());
    if (isNew) combinations_.emplace_back();
    combinations_[at->second].push_back(c);
  }
}

SightRay SightRays::ofCombination() {
  survey();
  const auto& combination = combinations_[dice_.below(combinations_.size())];
  SightRay ray = candidates_[combination[dice_.below(combination.size())]].ray;
  ray.fromFilm = false;
  return ray;
}

/// Lamps in view at a frame, each with what else its pixel shows.
std::vector<SightRay> SightRays::lamps(int frame) {
  std::vector<SightRay> seen;
  for (size_t l = 0; l < simulation_.lights.size(); ++l) {
    SightRay ray = startAt(frame);
    const glm::dvec3 line = ray.state->lights[l] - ray.line.origin;
    const double most = simulation_.limits.lightLevel;
    if (!simulation_.lights[l].visible || !(std::max(ray.state->lightLevels[l], most) > 0.0) || !(glm::length(line) > 0.0) ||
        (!inView(ray, line) && !turnToward(ray, frame, line)))
      continue;
    ray.line.direction = glm::normalize(line);
    ray.lamp = static_cast<int>(l);
    ray.fromFilm = false;
    cast(ray);
    if (ray.line.hits.solid.distance <= glm::length(line) || hiddenByGround(simulation_, ray.line.hits, ray.line.origin, ray.line.direction, glm::length(line)))
      continue;
    if (most > 0.0) {  // as bright as it may come
      SightRay brightest = ray;
      auto state = std::make_shared<WorldState>(*ray.state);
      state->lightLevels[l] = most;
      brightest.state = std::move(state);
      seen.push_back(std::move(brightest));
    }
    if (ray.state->lightLevels[l] > 0.0) seen.push_back(std::move(ray));
  }
  return seen;
}

/// Where the beams of lights fall at a frame, in view: they may be few pixels.
std::vector<SightRay> SightRays::beams(int frame) {
  std::vector<SightRay> lit;
  for (size_t l = 0; l < simulation_.lights.size(); ++l) {
    const PointLight& light = simulation_.lights[l];
    if (!light.pattern.body || light.lamp >= 0) continue;
    SightRay ray = startAt(frame);
    const WorldState& state = *ray.state;
    const Hit fall =
        castRay(simulation_, state, state.lights[l], state.lightPoses[l].orientation * glm::dvec3(1, 0, 0), light.radius_m, nullptr, false, 0).solid;
    const glm::dvec3 line = fall.point - ray.line.origin;
    if (!(state.lightLevels[l] > 0.0) || fall.entity < 0 || !(glm::length(line) > 0.0) || (!inView(ray, line) && !turnToward(ray, frame, line))) continue;
    ray.line.direction = glm::normalize(line);
    ray.fromFilm = false;
    cast(ray);
    if (ray.line.hits.solid.entity == fall.entity) lit.push_back(std::move(ray));
  }
  return lit;
}

/// Where lights may begin to shine, or shine most: at the bends of their courses and where commands begin to hold.
std::vector<int> SightRays::framesOfLevels() const {
  std::vector<int> frames;
  for (const Command& c : simulation_.commands) frames.push_back(frameOf(c.at_s));
  const auto around = [&](double time_s) {
    for (int before : {0, 1}) frames.push_back(std::max(frameOf(time_s) - before, 0));
  };
  for (const PointLight& light : simulation_.lights) {
    if (!light.level.empty())
      for (double time_s : light.level.bends_s(-INFINITY, simulation_.time.at(simulation_.time.frames - 1), kMostLevels)) around(time_s);
    for (double end_s : {light.lifetime.begin_s, light.lifetime.end_s})
      if (std::isfinite(end_s)) around(end_s);
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  // Of very many some, evenly.
  std::vector<int> some;
  for (size_t k = 0; k < std::min(frames.size(), kMostLevels); ++k) some.push_back(frames[k * frames.size() / std::min(frames.size(), kMostLevels)]);
  return some;
}

/// Those in which a surface is hottest and coldest.
std::vector<int> SightRays::framesOfTemperatures(const Surface& surface) const {
  if (surface.temperature.empty()) return {};
  const TimeAxis& time = simulation_.time;
  std::vector<double> times = surface.temperature.bends_s(time.at(0), time.at(time.frames - 1), kMostLevels);
  times.insert(times.end(), {time.at(0), time.at(time.frames - 1)});
  const auto less = [&](double a, double b) { return surface.temperature.at(a) < surface.temperature.at(b); };
  const auto [coldest, hottest] = std::minmax_element(times.begin(), times.end(), less);
  return {frameOf(*coldest), frameOf(*hottest)};
}

const std::vector<SightRay>& SightRays::extremes() {
  if (extremes_.empty()) findExtremes();
  return extremes_;
}

namespace {

/// What a ray meets of a surface.
const Hit* hitOn(const SightRay& ray, std::pair<int, int> surface) {
  const auto is = [&](const Hit& h) { return h.entity == surface.first && h.surface == surface.second; };
  if (is(ray.line.hits.solid)) return &ray.line.hits.solid;
  const auto at = std::find_if(ray.line.hits.layers.begin(), ray.line.hits.layers.end(), is);
  return at == ray.line.hits.layers.end() ? nullptr : &*at;
}

}  // namespace

std::optional<SightRay> SightRays::glint(const std::vector<size_t>& combination, std::pair<int, int> surface, size_t light) {
  const auto offOf = [&](const SightRay& r) {
    const Hit* hit = hitOn(r, surface);
    return hit ? offMirror(simulation_, *r.state, *hit, r.line.direction, light) : INFINITY;
  };
  size_t best = combination.front();
  double least = INFINITY;
  for (size_t c : combination)
    if (const double off = offOf(candidates_[c].ray); off < least) least = off, best = c;
  if (!(least < INFINITY)) return {};
  SightRay ray = candidates_[best].ray;
  const double distance = hitOn(ray, surface)->distance;
  double step = std::min(0.3 * static_cast<double>(simulation_.entities[static_cast<size_t>(surface.first)].boundingRadius_m) / distance, 0.05);
  for (int n = 0; n < kGlintSteps; ++n, step *= kShorter) {
    SightRay next = ray;
    const glm::dvec3 aside(dice_.unit() - 0.5, dice_.unit() - 0.5, dice_.unit() - 0.5);
    next.line.direction = glm::normalize(ray.line.direction + 2.0 * step * aside);
    if (!inView(next, distance * next.line.direction)) continue;
    cast(next);
    if (candidate(next).things != candidates_[best].things || !(offOf(next) < least)) continue;
    least = offOf(next);
    ray = std::move(next);
  }
  if (!(glintOf(simulation_, *ray.state, *hitOn(ray, surface), ray.line.direction, light) > 0.0)) return {};
  ray.fromFilm = false;
  ray.glints = true;
  return ray;
}

void SightRays::findGlints(const std::vector<size_t>& combination) {
  const RayHits& hits = candidates_[combination.front()].ray.line.hits;
  std::vector<std::pair<int, int>> glossy;
  if (isGlossy(simulation_, hits.solid)) glossy.emplace_back(hits.solid.entity, hits.solid.surface);
  for (const Hit& h : hits.layers)
    if (isGlossy(simulation_, h)) glossy.emplace_back(h.entity, h.surface);
  for (const auto& surface : glossy)
    for (size_t l = 0; l < countLights(simulation_); ++l)
      if (l < kGlintLamps || l == simulation_.lights.size())
        if (auto ray = glint(combination, surface, l)) extremes_.push_back(std::move(*ray));
}

/// Lamps, and each surface where its body is nearest and farthest.
void SightRays::findNearAndFar() {
  // The frames at which each body is nearest and farthest, and the first and last.
  const int frames = simulation_.time.frames, looked = std::min(frames, kMostFrames);
  struct Extent {
    double nearest = INFINITY, farthest = 0.0;
    int nearestFrame = 0, farthestFrame = 0;
  };
  std::vector<Extent> bodies(simulation_.entities.size()), lights(simulation_.lights.size());
  for (int k = 0; k < looked; ++k) {
    const int frame = looked > 1 ? static_cast<int>(static_cast<long long>(k) * (frames - 1) / (looked - 1)) : 0;
    const SightRay start = startAt(frame);
    auto look = [&](Extent& e, const glm::dvec3& place) {
      const double d = glm::length(place - start.line.origin);
      if (d < e.nearest) e.nearest = d, e.nearestFrame = frame;
      if (d > e.farthest) e.farthest = d, e.farthestFrame = frame;
    };
    for (size_t e = 0; e < bodies.size(); ++e)
      if (start.state->isThere(e)) look(bodies[e], start.state->entities[e].position);
    for (size_t l = 0; l < lights.size(); ++l) look(lights[l], start.state->lights[l]);
  }
  std::vector<int> lampFrames = {0, frames / 2, frames - 1};
  for (const Extent& l : lights) lampFrames.insert(lampFrames.end(), {l.nearestFrame, l.farthestFrame});
  for (int frame : framesOfLevels()) lampFrames.push_back(frame);
  std::sort(lampFrames.begin(), lampFrames.end());
  lampFrames.erase(std::unique(lampFrames.begin(), lampFrames.end()), lampFrames.end());
  for (int frame : lampFrames) {
    for (SightRay& r : lamps(frame)) extremes_.push_back(std::move(r));
    for (SightRay& r : beams(frame)) extremes_.push_back(std::move(r));
  }
  for (size_t s = 0; s < surfaces_.size(); ++s) {
    const Extent& e = bodies[surfaces_[s].first];
    std::vector<int> which = {e.nearestFrame, e.farthestFrame};
    for (int frame : framesOfTemperatures(simulation_.entities[surfaces_[s].first].surfaces[surfaces_[s].second])) which.push_back(frame);
    for (int frame : which)
      if (auto ray = aimedAt(frame, s)) extremes_.push_back(std::move(*ray));
  }
}

/// What lines of a combination have extremes of.
std::array<double, 9> SightRays::figuresOf(const SightRay& r) const {
  const RayHits& h = r.line.hits;
  const double cosView = h.solid.entity >= 0 ? -glm::dot(h.solid.normal, r.line.direction) : 0.0;
  double media_m = 0.0, texel_K = 0.0;
  for (const Stretch& s : h.stretches) media_m += s.leave - s.enter;
  double field = 0.0, field_K = 0.0;  // of what a line passes: the first gas's amount, the hottest part of it
  for (const Slab& s : h.slabs) {
    field += s.step.amount[0];
    field_K = std::max(field_K, s.step.temperature_K);
  }
  if (h.solid.entity >= 0) {
    const Surface& s = simulation_.entities[static_cast<size_t>(h.solid.entity)].surfaces[static_cast<size_t>(h.solid.surface)];
    if (s.temperatureTexture >= 0) texel_K = textureValue(simulation_.textures[static_cast<size_t>(s.temperatureTexture)], h.solid.uv);
  }
  const double up = glm::dot(r.line.direction, simulation_.frame.up(r.line.origin));
  const double toSun = simulation_.sun ? glm::dot(r.line.direction, simulation_.sun->toSun) : 0.0;
  return {h.solid.entity >= 0 ? h.solid.distance : 0.0, cosView, media_m, texel_K, up, std::abs(up), toSun, field, field_K};
}

void SightRays::findExtremes() {
  survey();
  findNearAndFar();
  std::vector<const std::vector<size_t>*> order;
  for (const auto& c : combinations_) order.push_back(&c);
  std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) { return a->size() > b->size(); });
  if (order.size() > kMostExtremes) order.resize(kMostExtremes);
  for (const auto* combination : order) {
    const size_t count = figuresOf(candidates_[combination->front()].ray).size();
    for (size_t f = 0; f < count; ++f) {
      const auto less = [&](size_t a, size_t b) { return figuresOf(candidates_[a].ray)[f] < figuresOf(candidates_[b].ray)[f]; };
      const auto [low, high] = std::minmax_element(combination->begin(), combination->end(), less);
      for (size_t c : {*low, *high}) {
        extremes_.push_back(candidates_[c].ray);
        extremes_.back().fromFilm = false;
        if (*low == *high) break;
      }
    }
    findGlints(*combination);
  }
}

}  // namespace pitviper
