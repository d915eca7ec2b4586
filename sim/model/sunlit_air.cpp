#include "sim/model/sunlit_air.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pitviper {

SunlitAir::SunlitAir(const Path& path, const AirRay& ray, std::vector<AirStation> along, const SunLegs* legs, const RaySun& sun) : stations(std::move(along)) {
  const double r0 = ray.earthRadius_m + ray.height_m;
  for (const AirStation& s : stations) {
    powered.push_back(path.powered(s.amounts));
    if (!legs) continue;
    // The sun's elevation there: its direction does not change, the vertical does.
    const double sine = std::clamp((r0 * sun.sinElevation + s.range_m * sun.cosScatter) / (ray.earthRadius_m + s.height_m), -1.0, 1.0);
    lit.push_back(!legs->inShadow(s.height_m, sine));
    both.push_back(lit.back() ? path.powered(s.amounts + legs->at(s.height_m, sine)) : AirAmounts{});
  }
}

AirRadiance airRadiance(const AirNode& node, const SunlitAir& air, std::span<const double> source) {
  const size_t n = air.stations.size();
  AirRadiance out;
  out.depth.resize(n);
  out.thermal.resize(n);
  std::vector<double> absorbed(n), molecules(n), haze(n), black(n);
  for (size_t s = 0; s < n; ++s) {
    double d = 0.0, m = 0.0, p = 0.0;
    for (size_t k = 0; k < node.extinction.size(); ++k) {
      const double u = air.powered[s].amount[k];
      d += node.extinction[k] * u, m += node.molecules[k] * u, p += node.haze[k] * u;
    }
    out.depth[s] = d, molecules[s] = m, haze[s] = p, absorbed[s] = d - m - p;
    black[s] = node.source + source[s];
  }
  AirLight{out.depth}.emitted(absorbed, black, out.thermal);
  if (air.lit.empty()) return out;
  std::vector<double> both(n, std::numeric_limits<double>::infinity());
  for (size_t s = 0; s < n; ++s)
    if (air.lit[s]) both[s] = Path::depthOf(node, air.both[s]);
  out.molecules.resize(n);
  out.haze.resize(n);
  AirLight{out.depth}.scattered(molecules, both, out.molecules);
  AirLight{out.depth}.scattered(haze, both, out.haze);
  return out;
}

}  // namespace pitviper
