#include "sim/radiance/air_places.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// The air's own places and those asked for, and between them so many more that none is farther from the last than 100 m or a tenth of the way:
/// emission, linear in depth between two, is then within 3e-5 of finer ones towards space, where the model's own places are 0.13 % off.
constexpr double kStep_m = 100.0, kPart = 0.1;

std::vector<double> subdivided(std::vector<double> at) {
  std::vector<double> all = {at.front()};
  for (size_t i = 1; i < at.size(); ++i) {
    const double step = at[i] - at[i - 1];
    const int parts = std::max(1, static_cast<int>(std::ceil(step / std::max(kStep_m, kPart * (at[i - 1] - at.front())))));
    for (int k = 1; k < parts; ++k) all.push_back(at[i - 1] + step * k / parts);
    all.push_back(at[i]);
  }
  return all;
}

/// About evenly spread members of a list with its first and last.
std::vector<double> thinned(const std::vector<double>& all, size_t count) {
  if (all.size() <= count) return all;
  std::vector<double> some;
  for (size_t k = 0; k < count; ++k) some.push_back(all[k * (all.size() - 1) / (count - 1)]);
  return some;
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
  const Path& path = *sim.path;
  const AirRay ray{sim.frame.height(line.origin), glm::dot(line.direction, sim.frame.up(line.origin)), sim.frame.earthRadius_m()};
  if (path.isLayered()) {
    std::vector<double> own;
    for (const AirStation& s : path.stations(ray, ranges.back())) own.push_back(s.range_m);
    if (scene.airPlaces > 0) {
      own = thinned(own, static_cast<size_t>(scene.airPlaces));
    } else {
      std::erase_if(own, [&](double r) { return r > ranges.back(); });
      const double begin = own.front(), end = own.back();
      for (double r : ranges)
        if (r > begin && r < end) own.push_back(r);
      std::sort(own.begin(), own.end());
      own = subdivided(std::move(own));
    }
    mergeInto(ranges, own);
  }
  RaySun sun;
  if (sim.sun) sun = {glm::dot(sim.sun->toSun, sim.frame.up(line.origin)), glm::dot(line.direction, sim.sun->toSun)};
  sunlit_ = scene.terms.scatteredSun;
  cosScatter_ = sun.cosScatter;
  const SunlitAir air(path, ray, path.stationsAt(ray, ranges), sunlit_ ? scene.sunLegs : nullptr, sun);
  for (size_t i = 0; i < ranges.size(); ++i) {
    places_.push_back({ranges[i], air.stations[i].temperature_K, air.powered[i], sunlit_ ? air.both[i] : AirAmounts{}, sunlit_ ? air.lit[i] : 0.0});
    amounts_.push_back(air.stations[i].amounts);
  }
}

}  // namespace pitviper
