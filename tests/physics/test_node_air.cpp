// What air sends at all nodes at once against the same node by node: two writings of one law.
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/layered_grid.hpp"
#include "sim/plan/plan.hpp"
#include "sim/radiance/node_air.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/air_radiance.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

TEST(NodeAir, AsNodeByNode) {
  double worst = 0.0;
  for (double elevation : {60.0, 3.0, 0.2}) {
    const Simulation sim =
        scene("atmosphere: hazy_us76\nsun: {azimuth: 200 deg, elevation: " + std::to_string(elevation) +
              " deg, temperature: 5772 K}\ncameras: [{name: c, film: {width: 4, height: 4}, field_of_view: 2 deg, aperture: 10 mm, position: [0 m, 0 m, 900 "
              "m], heading: 0 deg, spectral: {samples: 6}, channels: [{name: vis, response: {band: [0.5 um, 0.7 um]}}, {name: mw, response: {band: [3 um, 5 "
              "um]}}, {name: lw, response: {band: [8 um, 12 um]}}]}]\n");
    const Plan plan = makePlan(sim, sim.cameras[0].outputs, sim.cameras[0].spectral, {});
    const NodeAir air(plan.nodes);
    const size_t nodes = plan.nodes.size();
    for (double sine : {-0.9, -0.02, 0.0, 0.01, 0.6})
      for (double across : {-0.9, 0.0, 0.9}) {
        const AirRay ray{900.0, sine, sim.frame.earthRadius_m()};
        const double sunSine = std::sin(elevation * kPi / 180.0);
        const RaySun sun{sunSine, sine * sunSine + std::sqrt(1.0 - sine * sine) * std::sqrt(1.0 - sunSine * sunSine) * across};
        std::vector<double> ranges;
        for (double r = 0.0; r < (sine < 0.0 ? 900.0 / -sine : 3e5); r = 1.3 * r + 20.0) ranges.push_back(r);
        const SunlitAir line(*sim.air, ray, sim.air->stationsAt(ray, ranges), plan.sunLegs.get(), sun);
        const NodeRadiance all = air.along(line);
        for (size_t i = 0; i < plan.nodes.size(); ++i) {
          std::vector<double> source;
          for (const AirStation& s : line.stations) source.push_back(air.planck(s.temperature_K)[i]);
          const AirRadiance one = airRadiance(plan.nodes[i].air, line, source);
          const auto hold = [&](const std::vector<double>& found, const std::vector<double>& expected) {
            for (size_t s = 0; s < expected.size(); ++s)
              worst = std::max(worst, std::abs(found[s * nodes + i] - expected[s]) / std::max(std::abs(expected.back()), 1e-290));  // exp(-700) is 1e-304
          };
          hold(all.depth, one.depth);
          hold(all.thermal, one.thermal);
          hold(all.molecules, one.molecules);
          hold(all.haze, one.haze);
        }
      }
    for (double t : {150.0, 223.4, 288.15, 300.0, 500.0})
      for (size_t i = 0; i < plan.nodes.size(); ++i)
        EXPECT_NEAR(air.planck(t)[i] / plan.nodes[i].planck(t), 1.0, 3e-4) << t << ": 256 entries over 1/T, linear in ln B: (c2 / lambda)^2 d^2 / 8";
  }
  bound("air of all nodes at once against node by node, depth, emission and scattered sunlight", worst, 1e-10,
        "double precision; order of sums, series of 1 - exp(-x)");
}

TEST(NodeAir, WhatIsLost) {
  for (double x : {0.0, 1e-12, 1e-3, 0.1249, 0.1251, 3.0, 800.0})
    EXPECT_NEAR(lostOf(std::vector<double>(3, x))[1], physics::oneMinusExp(x), 1e-15 + 1e-14 * x) << x;
}

// An eye a little higher than its tables' step sees past their horizon: rows below that one are asked for the sky.
TEST(NodeAir, SkyJustBelowTheTablesHorizon) {
  double worst = 0.0;
  for (const char* height : {"10.24 m", "10.01 m", "9.77 m", "3.13 m"})
    for (const char* field : {"0.03 deg", "0.5 deg"}) {
      const auto picture = [&](const char* accuracy) {
        const Frame f = renderFrame(
            scene(std::string("accuracy: ") + accuracy +
                  "\natmosphere: hazy_us76\nsun: {azimuth: 200 deg, elevation: 30 deg, temperature: 5772 K}\ncameras: [{name: c, film: {width: 64, height: 1}, "
                  "field_of_view: " +
                  field + ", aperture: 10 mm, position: [0 m, 0 m, " + height +
                  "], heading: 0 deg, pitch: -0.1 deg, roll: 90 deg, channels: [{name: vis, response: {band: [0.5 um, 0.52 um]}}, {name: lw, response: {band: "
                  "[10 um, "
                  "12 um]}}]}]\n"));
        return std::pair(layer(f, "vis.radiance").pixels, layer(f, "lw.radiance").pixels);
      };
      const auto planned = picture("5 %"), exact = picture("reference");
      for (size_t p = 0; p < exact.first.size(); ++p) {
        worst = std::max(worst, static_cast<double>(std::abs(planned.first[p] / exact.first[p] - 1.0f)));
        worst = std::max(worst, static_cast<double>(std::abs(planned.second[p] / exact.second[p] - 1.0f)));
      }
    }
  bound("horizon of the sea from 3 to 10 m up, asked to 5 %, worst pixel", worst, 0.05, "the accuracy asked for");
}

// No eye that shares a grid sees below the horizon that its rows are made for; below the grid's own some do.
TEST(NodeAir, LowestHorizonOfAGrid) {
  const Simulation sim = scene(
      "accuracy: 5 %\natmosphere: hazy_us76\ncameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 1 deg, aperture: 10 mm, position: [0 m, 0 m, 10 "
      "m], "
      "heading: 0 deg, channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n");
  Plan plan = makePlan(sim, sim.cameras[0].outputs, sim.cameras[0].spectral, {});
  plan.accuracy = 0.05;
  const WorldState state = advance(sim, 0.0);
  const double radius = sim.frame.earthRadius_m();
  int below = 0;
  for (double height = 0.03; height < 9000.0; height *= 1.037) {
    View view = cameraView(sim.cameras[0], state, 1);
    view.position.z = height;
    const AirGrids grids = airGrids(sim, plan, {65, 97}, view, state);
    AirGrid own = grids.below;
    own.places.height_m = sim.frame.height(view.position);
    EXPECT_LE(grids.below.places.height_m, own.places.height_m * (1.0 + 1e-12));
    EXPECT_GE(grids.above.places.height_m, own.places.height_m * (1.0 - 1e-12));
    for (const AirGrid& grid : {grids.below, grids.above}) EXPECT_LE(grid.lowestHorizon(radius), own.horizon(radius)) << height;
    below += own.horizon(radius) < grids.below.horizon(radius);
  }
  EXPECT_GT(below, 50);
}

}  // namespace
}  // namespace pitviper::test
