#include "sim/radiance/air_places.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// The air's own places and those asked for, and between them so many more that none is farther from the last than 2 m or a quarter of the way up to 100 m,
/// from there on than a tenth of it or 100 m: emission, linear in depth between two, is then within 3e-5 of finer ones towards space, where the model's own
/// places are 0.13 % off, and within 6e-5 where a band is so opaque that all it shows lies in the first metres, for its depth grows as a root of the range.
constexpr double kFirst_m = 2.0, kNearPart = 0.25, kStep_m = 100.0, kPart = 0.1;
/// How fewer places are spread: nearer than the first range one place is as good as another, and beyond the second there is no air to speak of.
constexpr double kNear_m = 10.0, kFar_m = 1e6;

/// The longest step from a place so far from the eye.
double stepAfter(double range_m) { return range_m < kStep_m ? std::max(kFirst_m, kNearPart * range_m) : std::max(kStep_m, kPart * range_m); }

std::vector<double> subdivided(std::vector<double> at) {
  std::vector<double> all = {at.front()};
  for (size_t i = 1; i < at.size(); ++i) {
    for (double from = at[i - 1]; from < at[i];) {
      const double rest = at[i] - from;
      const double most = stepAfter(from - at.front());
      // Even steps as far as they may be that long, growing ones near the eye.
      from = rest <= most ? at[i] : from + (most < kStep_m ? most : rest / std::ceil(rest / most));
      all.push_back(from);
    }
  }
  return all;
}

/// Picks `count` of rising places, the first and the last among them, where the air changes: half by the share of each absorber that lies before a place, half
/// by the logarithm of its range, as where much absorbs the near air is all that is seen.
std::vector<double> thinned(const Atmosphere& path, const AirRay& ray, const std::vector<double>& all, size_t count) {
  if (all.size() <= count) return all;
  const auto stations = path.stationsAt(ray, all);
  const AirAmounts& whole = stations.back().amounts;
  std::vector<double> measure;
  for (size_t i = 0; i < all.size(); ++i) {
    double share = 0.0, absorbers = 0.0;
    for (size_t k = 0; k < whole.amount.size(); ++k)
      if (whole.amount[k] > 0.0) share += stations[i].amounts.amount[k] / whole.amount[k], absorbers += 1.0;
    const double far = std::log1p((all[i] - all.front()) / kNear_m) / std::log1p(std::min(all.back() - all.front(), kFar_m) / kNear_m);
    measure.push_back((absorbers > 0.0 ? share / absorbers : 0.0) + std::min(far, 1.0));
  }
  std::vector<double> some;
  size_t i = 0;
  for (size_t k = 0; k < count; ++k) {
    const double wanted = measure.back() * static_cast<double>(k) / static_cast<double>(count - 1);
    while (i + 1 < all.size() && measure[i] < wanted) ++i;
    if (some.empty() || all[i] > some.back()) some.push_back(all[i]);
  }
  if (some.back() < all.back()) some.push_back(all.back());
  return some;
}

/// The sun sets along a line in steps: from one place to the next its disc rises or sinks by no more than this part of its radius.
constexpr double kSunStep = 0.02;

std::vector<double> refinedAtDusk(const AirRay& ray, const RaySun& sun, const std::vector<double>& at) {
  const double r0 = ray.earthRadius_m + ray.height_m;
  // Radii of the disc that its centre stands above the horizon there.
  const auto above = [&](double s) {
    const double r = std::sqrt(std::max(r0 * r0 + s * (2.0 * r0 * ray.sinElevation + s), 0.0));
    return physics::sunAboveHorizon(r - ray.earthRadius_m, std::clamp((r0 * sun.sinElevation + s * sun.cosScatter) / r, -1.0, 1.0), ray.earthRadius_m);
  };
  std::vector<double> all = {at.front()};
  for (size_t i = 1; i < at.size(); ++i) {
    const double near = std::clamp(above(at[i - 1]), -1.0, 1.0), far = std::clamp(above(at[i]), -1.0, 1.0);
    const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(far - near) / kSunStep)));
    for (int k = 1; k < parts; ++k) all.push_back(at[i - 1] + (at[i] - at[i - 1]) * k / parts);
    all.push_back(at[i]);
  }
  return all;
}

/// Steps of a field stand close together: of places that are no nearer to the eye than two hundred times their distance, and no farther apart in height than
/// this, the first and the last are looked at, and between these amounts change evenly. They are then off by at most (10 m / 300 m) / 8 / 200, 2e-5, where a
/// haze falls to a third in 300 m.
constexpr double kEvenPart = 0.005, kEvenHigher_m = 10.0;

/// The numbers of the ranges that are looked at: all but ends of steps through fields that are so close together that the air hardly changes.
std::vector<size_t> lookedAt(const std::vector<double>& ranges, const std::vector<Slab>& slabs, double sine) {
  std::vector<double> steps;
  for (const Slab& s : slabs) steps.insert(steps.end(), {s.step.enter_m, s.step.leave_m});
  std::sort(steps.begin(), steps.end());
  std::vector<size_t> some = {0};
  for (size_t i = 1; i < ranges.size(); ++i) {
    const double last = ranges[some.back()], apart = std::min(kEvenPart * last, kEvenHigher_m / std::max(std::abs(sine), 1e-9));
    if (i + 1 == ranges.size() || ranges[i + 1] - last > apart || !std::binary_search(steps.begin(), steps.end(), ranges[i])) some.push_back(i);
  }
  return some;
}

AirAmounts mixed(const AirAmounts& near, const AirAmounts& far, double share) {
  AirAmounts all;
  for (size_t k = 0; k < all.amount.size(); ++k) all.amount[k] = near.amount[k] + share * (far.amount[k] - near.amount[k]);
  return all;
}

void mergeInto(std::vector<double>& at, const std::vector<double>& more) {
  at.insert(at.end(), more.begin(), more.end());
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
}

}  // namespace

AirPlaces::AirPlaces(const RadianceScene& scene, const LineOfSight& line, std::vector<double> ranges) {
  const Simulation& sim = scene.simulation;
  if (!scene.terms.air) {
    for (double r : ranges) places_.push_back({r, 0.0, {}, {}, 0.0});
    amounts_.resize(places_.size());
    return;
  }
  const Atmosphere& path = *sim.air;
  const AirRay ray{sim.frame.height(line.origin), glm::dot(line.direction, sim.frame.up(line.origin)), sim.frame.earthRadius_m()};
  RaySun sun;
  if (sim.sun) sun = {glm::dot(sim.sun->toSun, sim.frame.up(line.origin)), glm::dot(line.direction, sim.sun->toSun)};
  if (path.traits().variesAlongWay) {
    std::vector<double> own = path.placesAlong(ray, ranges.back());
    std::erase_if(own, [&](double r) { return r > ranges.back(); });
    const double begin = own.front(), end = own.back();
    for (double r : ranges)
      if (r > begin && r < end) own.push_back(r);
    std::sort(own.begin(), own.end());
    own = subdivided(std::move(own));
    if (scene.terms.scatteredSun && sim.sun) own = refinedAtDusk(ray, sun, own);
    if (scene.airPlaces > 0) own = thinned(path, ray, own, static_cast<size_t>(scene.airPlaces));
    own = withShellPlaces(path, ray, own);
    mergeInto(ranges, own);
  }
  sunlit_ = scene.terms.scatteredSun;
  cosScatter_ = sun.cosScatter;
  const std::vector<size_t> seen = lookedAt(ranges, line.hits.slabs, ray.sinElevation);
  std::vector<double> at;
  for (size_t i : seen) at.push_back(ranges[i]);
  const SunlitAir air(path, ray, path.stationsAt(ray, at), sunlit_ ? scene.sunLegs : nullptr, sun);
  cosAzimuth_ = air.cosAzimuth;
  places_.reserve(ranges.size()), amounts_.reserve(ranges.size());
  for (size_t i = 0, k = 0; i < ranges.size(); ++i) {
    if (k + 1 < seen.size() && i >= seen[k + 1]) ++k;
    const size_t next = i == seen[k] ? k : k + 1;
    const double share = next == k ? 0.0 : (ranges[i] - at[k]) / (at[next] - at[k]);
    const AirStation &near = air.stations[k], &far = air.stations[next];
    places_.push_back({ranges[i], near.temperature_K + share * (far.temperature_K - near.temperature_K), mixed(air.powered[k], air.powered[next], share),
                       sunlit_ ? mixed(air.both[k], air.both[next], share) : AirAmounts{}, sunlit_ ? air.lit[k] + share * (air.lit[next] - air.lit[k]) : 0.0,
                       near.height_m + share * (far.height_m - near.height_m), air.sine[k] + share * (air.sine[next] - air.sine[k])});
    amounts_.push_back(mixed(near.amounts, far.amounts, share));
  }
}

}  // namespace pitviper
