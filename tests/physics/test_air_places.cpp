// The places at which the radiance equation looks at air, against the same air looked at hundreds of times as finely.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/model/sunlit_air.hpp"
#include "sim/plan/plan.hpp"
#include "sim/radiance/node_sum.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0;

Simulation worldOf(const std::string& air, double sun_deg) {
  return scene("atmosphere: " + air + "\nsun: {azimuth: 60 deg, elevation: " + std::to_string(sun_deg) +
               " deg, temperature: 5772 K}\n"
               "cameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, heading: 0 deg, pitch: 10 deg, aperture: 5 mm, channels: [{name: a, "
               "response: {band: [1 um, 1.1 um]}}]}]\n");
}

/// At one wavelength, of the air alone towards space: by the radiance equation, and by places half a per cent of their range apart.
struct Seen {
  double equation = 0.0, finely = 0.0;
};

Seen lookAlong(const Simulation& sim, double um, double height_m, const glm::dvec3& direction) {
  const SpectralNode node = nodeAt(sim, um);
  const auto legs = SunLegs::of(sim.air, sim.sun->toSun.z, sim.frame.earthRadius_m());
  const WorldState state = advance(sim, 0.0);
  const LineOfSight line{{0.0, 0.0, height_m}, glm::normalize(direction), {}, 0.0};
  const std::vector<SpectralNode> nodes{node};
  const NodeSpectra spectra(sim, nodes);
  NodeSum sum(spectra);
  const Terms terms = termsOf(sim);
  sum.begin();
  radianceAlong({sim, terms, legs.get(), state, {}, 0}, line, sum);

  std::vector<double> ranges{0.0};
  for (double r = 0.02; r < 3e6; r *= 1.005) ranges.push_back(r);
  ranges.push_back(physics::kFar);
  const AirRay ray{height_m, line.direction.z, sim.frame.earthRadius_m()};
  const RaySun sun{sim.sun->toSun.z, glm::dot(line.direction, sim.sun->toSun)};
  const SunlitAir air(*sim.air, ray, sim.air->stationsAt(ray, ranges), legs.get(), sun);
  std::vector<double> source;
  for (const AirStation& s : air.stations) source.push_back(s.temperature_K > 0.0 ? physics::planckRadiance(um, s.temperature_K) : 0.0);
  const AirRadiance found = airRadiance(node.air, air, source);
  const double irradiance = sim.sun->irradiance(um);
  return {sum.radiance()[0], found.thermal.back() + irradiance * (rayleighPhase(sun.cosScatter) * found.molecules.back() +
                                                                  henyeyGreensteinPhase(sun.cosScatter, node.air.asymmetry) * found.haze.back())};
}

// Where a band is opaque all that is seen lies in the first metres, and its depth grows as a root of the range there.
TEST(AirPlaces, FirstMetresOfOpaqueBands) {
  const Simulation sim = worldOf("clear_us76", 40.0);
  double worst = 0.0;
  for (double um : {2.62, 2.7, 4.26, 6.3, 7.1, 13.9})
    for (double elevation : {1.0, 19.5, 60.0})
      for (double height : {5.0, 1500.0}) {
        const Seen s = lookAlong(sim, um, height, {0.0, std::cos(elevation * kDegree), std::sin(elevation * kDegree)});
        worst = std::max(worst, std::abs(s.equation / s.finely - 1.0));
      }
  bound("sky in opaque bands, places of the equation against half a per cent of the range apart, relative", worst, 1e-4,
        "emission linear in depth between places");
}

// The sun's disc sets along the line: light ends within a fraction of the places' usual steps.
TEST(AirPlaces, SunThatSetsAlongALine) {
  double worst = 0.0;
  for (double sun_deg : {-0.9, -0.6, -0.3}) {
    const Simulation sim = worldOf("hazy_mls", sun_deg);
    for (double um : {0.55, 1.63})
      for (double elevation : {2.0, 8.0, 30.0})
        for (double height : {5.0, 545.0}) {
          const Seen s = lookAlong(sim, um, height, {0.0, std::cos(elevation * kDegree), std::sin(elevation * kDegree)});
          worst = std::max(worst, std::abs(s.equation / s.finely - 1.0));
        }
  }
  bound("sky under a sun that sets along the line, the same", worst, 1e-3, "depths linear between places; the disc's share too");
}

}  // namespace
}  // namespace pitviper::test
