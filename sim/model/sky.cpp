#include "sim/model/sky.hpp"

#include <cmath>

#include "sim/model/sunlit_air.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

constexpr int kElevations = 6, kAzimuths = 6;
/// Places on a line of sight: closer together near its beginning, where most of what is seen lies.
constexpr double kRanges_m[] = {0.0, 50.0, 200.0, 600.0, 1500.0, 3e3, 5e3, 8e3, 12e3, 18e3, 28e3, 50e3, 100e3, physics::kFar};

}  // namespace

Spectrum meanSky(const std::shared_ptr<const Atmosphere>& of, const std::optional<Sun>& sun, const Spectrum& background, double height_m,
                 double earthRadius_m) {
  struct Direction {
    SunlitAir air;
    double weight, cosScatter;
  };
  const Atmosphere& path = *of;
  const auto legs = sun ? SunLegs::of(of, sun->toSun.z, earthRadius_m) : nullptr;
  std::vector<Direction> directions;
  for (const QuadratureNode& node : gaussLegendre(kElevations, 0.0, 1.0)) {
    const AirRay ray{height_m, node.x, earthRadius_m};
    const auto stations = path.stationsAt(ray, kRanges_m);
    const int azimuths = sun ? kAzimuths : 1;
    for (int a = 0; a < azimuths; ++a) {
      RaySun seen;
      if (sun) {
        const double across = std::sqrt((1.0 - node.x * node.x) * std::max(1.0 - sun->toSun.z * sun->toSun.z, 0.0));
        seen = {sun->toSun.z, node.x * sun->toSun.z + across * std::cos(kPi * (a + 0.5) / azimuths)};
      }
      directions.push_back({SunlitAir(path, ray, stations, legs.get(), seen), 2.0 * node.x * node.weight / azimuths, seen.cosScatter});
    }
  }
  Spectrum::Table table;
  table.name = "the sky of the air";
  table.wavelength_um = path.knots_um();
  for (double w : table.wavelength_um) {
    const AirNode node = path.node(w);
    const double irradiance = sun ? sun->irradiance(w) : 0.0, behind = background(w);
    double sum = 0.0;
    std::vector<double> source(std::size(kRanges_m));
    for (const Direction& d : directions) {
      for (size_t s = 0; s < source.size(); ++s) {
        const double t = d.air.stations[s].temperature_K;
        source[s] = t > 0.0 ? physics::planckRadiance(w, t) : 0.0;
      }
      const AirRadiance sent = airRadiance(node, d.air, source);
      double radiance = sent.thermal.back() + behind * std::exp(-sent.depth.back());
      if (sun)
        radiance += irradiance * (rayleighPhase(d.cosScatter) * sent.molecules.back() + henyeyGreensteinPhase(d.cosScatter, node.asymmetry) * sent.haze.back());
      sum += d.weight * radiance;
    }
    table.value.push_back(sum);
  }
  Spectrum sky(std::move(table));
  sky.setProvenance("mean of the sky of this scenario's air");
  return sky;
}

}  // namespace pitviper
