// The places at which the radiance equation looks at air, against the same air looked at hundreds of times as finely.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/plan/plan.hpp"
#include "sim/radiance/node_sum.hpp"
#include "sim/radiance/sunlit_air.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/world/field_states.hpp"
#include "tests/support/air_radiance.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/puff_scene.hpp"
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
  Terms terms = termsOf(sim);
  terms.streams = 0;  // sunlight scattered once and emission alone: their places are asked for
  const NodeSpectra spectra(sim, nodes, terms);
  NodeSum sum(spectra);
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
  return {sum.radiance()[0], found.thermal.back() + irradiance * (physics::rayleighPhase(sun.cosScatter) * found.molecules.back() +
                                                                  physics::henyeyGreensteinPhase(sun.cosScatter, node.air.meanAsymmetry) * found.haze.back())};
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

/// Holds what air is told between a field's steps and the sun against that of each step.
class WaysToTheSun final : public TermSink {
 public:
  WaysToTheSun(const Simulation& sim, const LineOfSight& line) : sim_(sim), line_(line) {}
  void restart() override {}
  void term(const Term&) override {}
  void pane(const Factor&, double) override {}
  void segment(const Segment& s) override {
    if (!s.sunAir) return;
    const AirRay ray{sim_.frame.height(line_.origin), glm::dot(line_.direction, sim_.frame.up(line_.origin)), sim_.frame.earthRadius_m()};
    const AirAmounts there = sunHere(sim_, line_.origin + 0.5 * (s.near.range_m + s.far.range_m) * line_.direction).air;
    const AirAmounts want = sim_.air->powered(sim_.air->amounts(ray, s.near.range_m) + there);
    for (size_t k = 0; k < want.amount.size(); ++k)
      if (want.amount[k] > 0.0) worst = std::max(worst, std::abs(s.sunAir->amount[k] / want.amount[k] - 1.0));
    ++told;
  }
  double worst = 0.0;
  int told = 0;

 private:
  const Simulation& sim_;
  const LineOfSight& line_;
};

// Steps of a cloud of smoke stand closer together than air changes: its way to the sun is told at few of them.
TEST(AirPlaces, WaysToTheSunAlongAField) {
  for (double sun_deg : {2.0, 15.0, 60.0}) {
    Simulation sim = worldOf("hazy_mls", sun_deg);
    Medium smoke = greyGas(1e-3);
    smoke.albedo = Spectrum(0.5);
    addPuffs(sim, {puffAt({0.0, 3000.0, 900.0}, 150.0, 1.0, 300.0)}, smoke);
    const auto legs = SunLegs::of(sim.air, sim.sun->toSun.z, sim.frame.earthRadius_m());
    const WorldState state = advance(sim, 0.0);
    const Terms terms = termsOf(sim);
    const FieldState& field = *fieldOf(state, 0);
    double worst = 0.0;
    int told = 0;
    // Level, steeply up and down, and straight up: through layers of the table.
    for (const glm::dvec3 eye : {glm::dvec3(0.0, 0.0, 900.0), {0.0, 2500.0, 5.0}, {0.0, 2800.0, 2000.0}, {0.0, 3000.0, 5.0}})
      for (int steps : {6, 100}) {
        LineOfSight line{eye, glm::normalize(glm::dvec3(0.0, 3000.0, 900.0) - eye), {}, 0.0};
        std::vector<FieldStep> cut;
        field.along({line.origin, line.direction, 0.0, physics::kFar}, steps, cut);
        for (const FieldStep& s : cut) line.hits.slabs.push_back({0, s});
        WaysToTheSun sink(sim, line);
        radianceAlong({sim, terms, legs.get(), state, {}, 0}, line, sink);
        worst = std::max(worst, sink.worst), told += sink.told;
      }
    EXPECT_GT(told, 90);
    bound(print("air between the steps of a field and the sun at %g degrees, relative", sun_deg), worst, 2e-4,
          "linear over 10 m of height: (10 m / 300 m)^2 / 8 where a haze ends");
  }
}

}  // namespace
}  // namespace pitviper::test
