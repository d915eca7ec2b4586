#include "sim/radiance/sunlit_air.hpp"

#include <algorithm>

namespace pitviper {

SunlitAir::SunlitAir(const Atmosphere& path, const AirRay& ray, std::vector<AirStation> along, const SunLegs* legs, const RaySun& sun)
    : stations(std::move(along)) {
  const double r0 = ray.earthRadius_m + ray.height_m;
  for (const AirStation& s : stations) {
    powered.push_back(path.powered(s.amounts));
    if (!legs) continue;
    // The sun's elevation there: its direction does not change, the vertical does.
    const double sine = std::clamp((r0 * sun.sinElevation + s.range_m * sun.cosScatter) / (ray.earthRadius_m + s.height_m), -1.0, 1.0);
    const RisenSun risen = risenSun(s.height_m, sine, ray.earthRadius_m);
    lit.push_back(risen.share);
    both.push_back(risen.share > 0.0 ? path.powered(s.amounts + legs->at(s.height_m, risen.sinElevation)) : AirAmounts{});
  }
}

}  // namespace pitviper
