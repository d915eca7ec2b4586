// A plan made within a scenario's limits, held against every wavelength in double precision at poses that the scenario itself never shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "sim/plan/planner.hpp"
#include "sim/render/reference/reference_pixel.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kAccuracy = 0.01;

/// A ball 600 m off, at 300 K, under a lamp that the scenario lets glow; the camera looks north, turned up, from a height.
struct Sight {
  double height_m, elevation_rad;
  glm::dvec3 direction() const { return {0.0, std::cos(elevation_rad), std::sin(elevation_rad)}; }
  /// Of a place so far off, and so much above the line.
  std::string at(double range_m, double above_m = 0.0) const {
    const glm::dvec3 p = range_m * direction();
    return "[0 m, " + std::to_string(p.y) + " m, " + std::to_string(height_m + p.z + above_m) + " m]";
  }
};

std::string ball(const Sight& sight, const std::string& limits) {
  return limits +
         "atmosphere: hazy_us76\naccuracy: 1 %\nsun: {azimuth: 200 deg, elevation: 40 deg, temperature: 5772 K}\nambient: {from: sky}\n"
         "materials: {m: {components: [{reflection: lambertian, reflectance: {wavelength: um, unit: \"1\", values: [[0.3, 0.5], [4, 0.2], [4.4, 0.35], [15, "
         "0.1]]}}]}}\n"
         "lights: [{name: lamp, intensity: {blackbody: 2200 K, area: 2 m2}, position: " +
         sight.at(560.0, 40.0) +
         ", level: [[0 s, 0.01]], visible: false}]\n"
         "entities: [{name: ball, shape: {model: sphere, radius: 10 m}, material: m, temperature: 300 K, position: " +
         sight.at(600.0) +
         "}]\n"
         "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 3 deg, aperture: 10 mm, position: " +
         sight.at(0.0) + ", look_at: " + sight.at(600.0) +
         ",\n"
         "  channels: [{name: mw, response: {band: [3.4 um, 5 um]}}, {name: lw, response: {band: [8 um, 12 um]}}]}]\n";
}

/// The largest error of a plan's wavelengths, in double precision, over both channels, in the middle of the ball: moved, heated, under a lamp turned up.
/// What every wavelength gives does not depend on the plan: the first that is asked about leaves it to the next.
double worstError(const Simulation& sim, const Plan& plan, const Sight& sight, const std::vector<double>& temperatures_K, std::vector<ReferencePixel>& every) {
  const Camera& camera = sim.cameras[0];
  SpectralSampling all = camera.spectral;
  all.reference = true;
  Plan fine = makePlan(sim, camera.outputs, all, camera.where);
  fine.textureAccuracy = plan.textureAccuracy;
  const std::vector<char> present(1, 1);
  const auto spectraOf = [&](const Plan& of) { return std::make_shared<const NodeSpectra>(sim, of.nodes, of.terms); };
  const auto few = spectraOf(plan), all_um = spectraOf(fine);
  double worst = 0.0;
  size_t number = 0;
  for (const double range_m : {550.0, 1500.0, 5e3, 12e3, 19e3})
    for (const double temperature_K : temperatures_K)
      for (const double level : {0.0, 0.3, 0.95}) {
        WorldState state = advance(sim, 0.0);
        for (double& surface_K : state.temperatures_K[0]) surface_K = temperature_K;
        const glm::dvec3 move = (range_m - 600.0) * sight.direction() + glm::dvec3(0.31, 0.0, 0.17);  // the ray misses edges of the mesh
        state.entities[0].position += move;
        state.lights[0] += move;
        state.lightLevels[0] = level;
        const View view = cameraView(camera, state, 1);
        const ReferencePixel got = ReferenceShader(sim, plan, view, state, present, few).pixel(4, 4);
        if (number == every.size()) every.push_back(ReferenceShader(sim, fine, view, state, present, all_um).pixel(4, 4));
        const ReferencePixel& want = every[number++];
        if (!sim.mediumOf(sim.entities[0])) {
          EXPECT_EQ(want.entity, 0);
          EXPECT_NEAR(want.range_m, range_m - 10.0, 1.0);
        }
        for (size_t s = 0; s < want.slots.size(); ++s) worst = std::max(worst, std::abs(got.slots[s] - want.slots[s]) / want.slots[s]);
      }
  return worst;
}

// Level, and up from the ground, where the way to a far body leads out of the dense air.
TEST(PlanLimits, HoldWhereTheScenarioNeverIs) {
  const std::string limits = "limits: {range: [500 m, 20 km], temperature: [250 K, 900 K], light: 1}\n";
  for (const auto& [name, sight] : {std::pair{"level, 1 km high", Sight{1000.0, 0.0}}, {"from the ground, 30 deg up", Sight{10.0, 0.5236}}}) {
    double worst[2];
    int nodes[2];
    std::vector<ReferencePixel> every;
    for (int with = 0; with < 2; ++with) {
      const Simulation sim = scene(ball(sight, with ? limits : ""));
      const Plan plan = planFor(sim, {&sim.cameras[0], nullptr});
      worst[with] = worstError(sim, plan, sight, {260.0, 330.0, 500.0, 880.0}, every);
      nodes[with] = plan.nodeCount();
    }
    std::printf(
        "%s: worst error of a 1 %% plan at 0.55 to 19 km, 260 to 880 K, lamp to 0.95: %.3f %% with %d groups for them, %.3f %% with %d for 300 K at 600 m\n",
        name, 100.0 * worst[1], nodes[1], 100.0 * worst[0], nodes[0]);
    bound(std::string("plan within limits, poses and temperatures unseen, ") + name + ", worst", worst[1], kAccuracy,
          "the accuracy asked for; not fitted to these lines of sight");
    EXPECT_GT(worst[0], kAccuracy) << "a plan for the scenario's own pose alone was good enough: this scene shows nothing of limits";
  }
}

// A plume's temperature comes live as a body's does.
TEST(PlanLimits, HoldForGas) {
  const Sight sight{1000.0, 0.0};
  const std::string gas =
      ", gas: {absorption: {wavelength: um, unit: 1/m, values: [[0.3, 0], [2.5, 0], [2.7, 0.2], [2.9, 0.001], [4.17, 0.001], [4.3, 2], [4.45, 1.5], [4.6, "
      "0.003], "
      "[15, 0.002]]}}";
  double worst[2];
  std::vector<ReferencePixel> every;
  for (int with = 0; with < 2; ++with) {
    std::string text = ball(sight, with ? "limits: {range: [500 m, 20 km], temperature: [280 K, 2000 K], light: 1}\n" : "");
    text.insert(text.find("}\nlights:"), gas);
    text.replace(text.find("accuracy: 1 %"), 13, "accuracy: 3 %");
    text.replace(text.find("material: m, temperature: 300 K"), 31, "material: gas, temperature: 300 K");
    const Simulation sim = scene(text);
    const Plan plan = planFor(sim, {&sim.cameras[0], nullptr});
    worst[with] = worstError(sim, plan, sight, {300.0, 600.0, 1200.0, 1900.0}, every);
  }
  std::printf("gas: %.3f %% with a plan for the limits, %.3f %% with one for 300 K at 600 m\n", 100.0 * worst[1], 100.0 * worst[0]);
  bound("plan within limits, gas at temperatures unseen, worst", worst[1], 0.03, "the accuracy asked for; not fitted to these lines of sight");
  EXPECT_GT(worst[0], 0.03);
}

}  // namespace
}  // namespace pitviper::test
