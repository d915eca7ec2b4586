#include "sim/camera/exposure_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/plan/budget.hpp"
#include "sim/world/ray_hits.hpp"

namespace pitviper {
namespace {

constexpr int kMostParts = 256;

/// Where a place of the world is on the film [pixels]; none behind it.
std::optional<glm::dvec2> filmOf(const View& v, const glm::dvec3& place) {
  const glm::dvec3 p = glm::transpose(v.localFromCamera) * (place - v.position);
  if (-p.z < v.near_m) return std::nullopt;
  return filmPosition(v, p);
}

/// How far anything in view goes on the film from the first of these times to the last [pixels]: what a grid of lines meets at the middle one, and middles of
/// bodies. `small`: of what is smaller than two pixels alone.
double motionOf(const Simulation& sim, const Camera& camera, const StateAt& stateAt, const std::array<double, 3>& times_s, double& small) {
  std::vector<WorldState> states;
  std::vector<View> views;
  for (double t : times_s) {
    states.push_back(stateAt(t));
    views.push_back(cameraView(camera, states.back(), 1));
  }
  double most = 0.0;
  // A place of what has a pose in each state.
  const auto followIn = [&](const auto& poseIn, const glm::dvec3& own) -> double {
    std::array<std::optional<glm::dvec2>, 3> at;
    for (std::size_t k = 0; k < at.size(); ++k) {
      const Pose pose = poseIn(states[k]);
      at[k] = filmOf(views[k], pose.position + pose.orientation * own);
      if (!at[k]) return 0.0;
    }
    const auto inView = [&](const glm::dvec2& p) { return p.x > -1.0 && p.y > -1.0 && p.x < views[1].width + 1.0 && p.y < views[1].height + 1.0; };
    if (!inView(*at[0]) && !inView(*at[1]) && !inView(*at[2])) return 0.0;
    const double way = glm::length(*at[1] - *at[0]) + glm::length(*at[2] - *at[1]);
    most = std::max(most, way);
    return way;
  };
  // A place of a body's own axes, or of the world.
  const auto follow = [&](int entity, const glm::dvec3& own) {
    return followIn([&](const WorldState& s) { return entity >= 0 ? s.entities[static_cast<std::size_t>(entity)] : Pose{}; }, own);
  };
  std::vector<char> drawn(sim.entities.size(), 1);
  if (camera.mount.carrier >= 0) drawn[static_cast<std::size_t>(camera.mount.carrier)] = 0;
  const View& v = views[1];
  constexpr int kLines = 12;
  constexpr double kFar_m = 1e7;
  for (int j = 0; j < kLines; ++j)
    for (int i = 0; i < kLines; ++i) {
      const glm::dvec3 ray = v.ray((i + 0.5) * v.width / kLines, (j + 0.5) * v.height / kLines), direction = v.localFromCamera * ray / glm::length(ray);
      const RayHits hits = castRay(sim, states[1], v.position, direction, v.near_m * glm::length(ray), &drawn, false, 0);
      if (hits.solid.entity < 0) {
        follow(-1, v.position + kFar_m * direction);
        continue;
      }
      const Pose& pose = states[1].entities[static_cast<std::size_t>(hits.solid.entity)];
      follow(hits.solid.entity, glm::inverse(pose.orientation) * (hits.solid.point - pose.position));
    }
  for (std::size_t e = 0; e < sim.entities.size(); ++e)
    if (drawn[e] && states[1].isThere(e)) {
      constexpr double kSmall_px = 2.0;
      const double way = follow(static_cast<int>(e), glm::dvec3(sim.entities[e].boundingCentre)),
                   range = glm::length(states[1].entities[e].position - v.position),
                   size = 2.0 * static_cast<double>(sim.entities[e].boundingRadius_m) / range / v.tanPerPixelX;
      if (size < kSmall_px) small = std::max(small, way);
    }
  for (std::size_t l = 0; l < sim.lights.size(); ++l) {
    if (!sim.lights[l].pattern.body || !(states[1].lightLevels[l] > 0.0)) continue;
    // Where its beam falls: the middle of what turns with it.
    const glm::dvec3 axis = states[1].lightPoses[l].orientation * glm::dvec3(1, 0, 0);
    const RayHits hits = castRay(sim, states[1], states[1].lights[l], axis, sim.lights[l].radius_m, &drawn, false, 0);
    if (hits.solid.entity >= 0) followIn([&](const WorldState& s) { return s.lightPoses[l]; }, {hits.solid.distance, 0.0, 0.0});
  }
  for (std::size_t l = 0; l < sim.lights.size(); ++l) {
    if (!sim.lights[l].visible) continue;
    std::array<std::optional<glm::dvec2>, 3> at;
    for (std::size_t k = 0; k < at.size(); ++k) at[k] = filmOf(views[k], states[k].lights[l]);
    if (at[0] && at[1] && at[2] && lightIsInView(sim, states[1], views[1], l))
      small = std::max(small, glm::length(*at[1] - *at[0]) + glm::length(*at[2] - *at[1]));
  }
  return std::max(most, small);
}

}  // namespace

ExposureParts exposureParts(const Simulation& sim, const Camera& camera, const StateAt& stateAt, double time_s) {
  // How outputs are exposed and read out.
  struct Timing {
    double exposure_s, line_s;
    bool operator==(const Timing&) const = default;
  };
  std::vector<Timing> timings;
  ExposureParts parts;
  parts.times_s = {time_s};
  const CameraState eye = cameraAt(camera, stateAt(time_s));
  for (const ChannelOutput& o : camera.outputs) {
    const DetectorLaw* law = detectorOf(camera, o.channel);
    const Timing own{camera.motionBlur ? eye.exposures_s.of(o.channel) : 0.0, law ? law->lineTime_s : 0.0};
    parts.timingOfOutput.push_back(static_cast<std::size_t>(std::find(timings.begin(), timings.end(), own) - timings.begin()));
    if (parts.timingOfOutput.back() == timings.size()) timings.push_back(own);
  }
  if (timings.empty()) timings.push_back({0.0, 0.0});
  double line_s = 0.0, exposure_s = 0.0, shortest_s = INFINITY;
  for (const Timing& t : timings)
    line_s = std::max(line_s, t.line_s), exposure_s = std::max(exposure_s, t.exposure_s), shortest_s = std::min(shortest_s, t.exposure_s);
  if (!(line_s > 0.0) && !(exposure_s > 0.0)) return parts;
  const int cells = cellsOf(camera), margin = marginOf(camera), rows = (camera.pinhole.height + 2 * margin) * cells;
  const auto rowTime = [&](int row, double ofLine_s) { return time_s + ((row + 0.5) / cells - margin - 0.5 * camera.pinhole.height) * ofLine_s; };
  const double first = rowTime(0, line_s) - 0.5 * exposure_s, last = rowTime(rows - 1, line_s) + 0.5 * exposure_s,
               asked = camera.spectral.accuracy > 0.0 ? camera.spectral.accuracy : kUsualAccuracy;
  parts.motion_px = motionOf(sim, camera, stateAt, {first, time_s, last}, parts.smallMotion_px);
  const bool addsUp = exposure_s > 0.0;
  const double ofShortest = addsUp ? exposure_s / shortest_s : 1.0;
  int count = camera.exposureParts;
  if (count == 0) {
    constexpr double kPicturesAPixel = 4.0;
    const double wanted = addsUp ? std::max(std::sqrt(ofShortest * parts.motion_px / (4.0 * budget::kMotion.of(asked))), kPicturesAPixel * parts.smallMotion_px)
                                 : parts.motion_px / (4.0 * budget::kMotion.of(asked));
    count = static_cast<int>(std::clamp(std::ceil(wanted), 1.0, static_cast<double>(kMostParts)));
  }
  parts.error = ofShortest * parts.motion_px / (4.0 * count * (addsUp ? count : 1));
  parts.streakError = addsUp ? std::min(1.0, parts.smallMotion_px / count) : 0.0;
  if (count == 1) return parts;
  const double step = (last - first) / count;
  parts.times_s.clear();
  for (int k = 0; k < count; ++k) parts.times_s.push_back(first + (k + 0.5) * step);
  for (const Timing& timing : timings) {
    std::vector<std::vector<double>>& ofTimes = parts.rowWeights.emplace_back();
    if (!(line_s > 0.0) && timing.exposure_s == exposure_s) continue;  // all alike
    for (int k = 0; k < count; ++k) {
      std::vector<double>& weights = ofTimes.emplace_back();
      for (int row = 0; row < rows; ++row) {
        const double t = rowTime(row, timing.line_s);
        if (addsUp) {  // the part of the row's exposure that is nearest to this time
          const double from = std::max(t - 0.5 * timing.exposure_s, first + k * step), to = std::min(t + 0.5 * timing.exposure_s, first + (k + 1) * step);
          weights.push_back(std::max(0.0, to - from) / timing.exposure_s);
        } else {
          const double at = std::clamp((t - first) / step - 0.5, 0.0, count - 1.0);
          weights.push_back(std::max(0.0, 1.0 - std::abs(at - k)));
        }
      }
    }
  }
  return parts;
}

CameraImage renderExposure(CameraRenderer& renderer, const Simulation& sim, const Camera& camera, double time_s,
                           const std::function<void(const WorldState&, CameraImage&)>& looked) {
  const StateAt stateAt = [&sim](double t) { return advance(sim, t); };
  return renderParts(renderer, exposureParts(sim, camera, stateAt, time_s), stateAt, looked);
}

CameraImage renderParts(CameraRenderer& renderer, const ExposureParts& parts, const StateAt& stateAt,
                        const std::function<void(const WorldState&, CameraImage&)>& looked) {
  const std::size_t count = parts.times_s.size(), middle = count / 2;
  CameraImage mean;
  std::vector<FilmPoint> points;
  for (std::size_t k = 0; k < count; ++k) {
    const WorldState state = stateAt(parts.times_s[k]);
    CameraImage image = renderer.render(state);
    if (k == middle && looked) looked(state, image);
    if (count == 1) return image;
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<const std::vector<double>*> weightsOf(image.slots.size(), nullptr);  // of rows; null: all alike
    for (std::size_t o = 0; o < parts.timingOfOutput.size(); ++o)
      if (const auto& ofTimes = parts.rowWeights[parts.timingOfOutput[o]]; !ofTimes.empty())
        weightsOf[static_cast<std::size_t>(image.slotOfOutput[o])] = &ofTimes[k];
    const auto weight = [&](std::size_t slot, std::size_t row) { return weightsOf[slot] ? (*weightsOf[slot])[row] : 1.0 / static_cast<double>(count); };
    for (std::size_t s = 0; s < image.slots.size(); ++s)
      for (std::size_t p = 0; p < image.slots[s].size(); ++p) image.slots[s][p] *= weight(s, p / width);
    for (FilmPoint p : image.points) {
      p.flux *= weight(static_cast<std::size_t>(p.slot), static_cast<std::size_t>(p.pixel) / width);
      if (p.flux != 0.0) points.push_back(p);
    }
    if (k > 0)
      for (std::size_t s = 0; s < image.slots.size(); ++s)
        for (std::size_t p = 0; p < image.slots[s].size(); ++p) image.slots[s][p] += mean.slots[s][p];
    std::vector<std::vector<double>> sums = std::move(image.slots);
    if (k == middle || k == 0) mean = std::move(image);
    mean.slots = std::move(sums);
  }
  mean.points = std::move(points);
  mean.exposureParts = static_cast<int>(count);
  mean.exposureMotion_px = parts.motion_px;
  mean.exposureError = parts.error;
  mean.streakError = parts.streakError;
  return mean;
}

}  // namespace pitviper
