#include "sim/radiance/sunlit_air.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// Space, where no elevation matters.
constexpr double kFarthest_m = 1e9;

}  // namespace

double cosAzimuthOf(double sinElevation, const RaySun& sun) {
  const double across = std::sqrt(std::max((1.0 - sinElevation * sinElevation) * (1.0 - sun.sinElevation * sun.sinElevation), 0.0));
  return across > 1e-9 ? std::clamp((sun.cosScatter - sinElevation * sun.sinElevation) / across, -1.0, 1.0) : 0.0;
}

SunlitAir::SunlitAir(const Atmosphere& path, const AirRay& ray, std::vector<AirStation> along, const SunLegs* legs, const RaySun& sun)
    : stations(std::move(along)), cosScatter(sun.cosScatter), cosAzimuth(legs ? cosAzimuthOf(ray.sinElevation, sun) : 0.0) {
  const double r0 = ray.earthRadius_m + ray.height_m;
  for (const AirStation& s : stations) {
    powered.push_back(path.powered(s.amounts));
    sine.push_back(std::clamp((r0 * ray.sinElevation + std::min(s.range_m, kFarthest_m)) / (ray.earthRadius_m + s.height_m), -1.0, 1.0));
    if (!legs) continue;
    // The sun's elevation there: its direction does not change, the vertical does.
    const double toSun = std::clamp((r0 * sun.sinElevation + s.range_m * sun.cosScatter) / (ray.earthRadius_m + s.height_m), -1.0, 1.0);
    const RisenSun risen = risenSun(s.height_m, toSun, ray.earthRadius_m);
    lit.push_back(risen.share);
    both.push_back(risen.share > 0.0 ? path.powered(s.amounts + legs->at(s.height_m, risen.sinElevation)) : AirAmounts{});
  }
}

}  // namespace pitviper
