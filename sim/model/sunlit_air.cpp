#include "sim/model/sunlit_air.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

namespace {

/// The absorbers that a coefficient is not zero of: most have one, few scatter.
struct Absorbers {
  explicit Absorbers(const std::array<double, kMostAirAmounts>& coefficients) {
    for (size_t k = 0; k < coefficients.size(); ++k)
      if (coefficients[k] != 0.0) number[count] = k, value[count++] = coefficients[k];
  }
  double depth(const AirAmounts& powered) const {
    double sum = 0.0;
    for (size_t j = 0; j < count; ++j) sum += value[j] * powered.amount[number[j]];
    return sum;
  }
  std::array<size_t, kMostAirAmounts> number{};
  std::array<double, kMostAirAmounts> value{};
  size_t count = 0;
};

}  // namespace

AirRadiance airRadiance(const AirNode& node, const SunlitAir& air, std::span<const double> source) {
  const size_t n = air.stations.size();
  AirRadiance out;
  out.depth.resize(n);
  out.thermal.resize(n);
  // One allocation: this is called for every wavelength of every line of sight.
  std::vector<double> room(5 * n);
  const auto part = [&](size_t i) { return std::span(room).subspan(i * n, n); };
  const std::span<double> molecules = part(0), haze = part(1), black = part(2), both = part(3), share = part(4);
  const Absorbers all(node.extinction), small(node.molecules), large(node.haze);
  for (size_t s = 0; s < n; ++s) {
    out.depth[s] = all.depth(air.powered[s]), molecules[s] = small.depth(air.powered[s]), haze[s] = large.depth(air.powered[s]);
    black[s] = node.source + source[s];
  }
  AirLight{out.depth}.emitted(black, out.thermal);
  if (air.lit.empty()) return out;
  for (size_t s = 0; s < n; ++s) both[s] = air.lit[s] > 0.0 ? all.depth(air.both[s]) : std::numeric_limits<double>::infinity();
  AirLight::reaching(both, air.lit, share);
  out.molecules.resize(n);
  out.haze.resize(n);
  double fromMolecules = 0.0, fromHaze = 0.0;
  for (size_t s = 1; s < n; ++s) {
    out.molecules[s] = fromMolecules += std::max(molecules[s] - molecules[s - 1], 0.0) * share[s];
    out.haze[s] = fromHaze += std::max(haze[s] - haze[s - 1], 0.0) * share[s];
  }
  return out;
}

}  // namespace pitviper
