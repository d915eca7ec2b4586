// Layers of cloud in the air: what lines pass of them, their light against photons and closed forms, pictures from below, within and above.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/camera/camera_renderer.hpp"
#include "sim/plan/planner.hpp"
#include "sim/radiance/node_sum.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/photon_walk.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string skyScene(const std::string& air, double sun_deg, double height_m, double pitch_deg, const std::string& more = "") {
  return "atmosphere: " + air + "\nsun: {azimuth: 0 deg, elevation: " + print("%g", sun_deg) + " deg, temperature: 5772 K}\n" + more +
         "cameras: [{name: e, film: {width: 3, height: 3}, field_of_view: 0.1 deg, aperture: 5 mm, position: [0 m, 0 m, " + print("%g", height_m) +
         " m], heading: 30 deg, pitch: " + print("%g", pitch_deg) +
         " deg, channels: [{name: b, response: {band: [0.549 um, 0.551 um]}, output: radiance_per_um}, "
         "{name: r, response: {band: [0.869 um, 0.871 um]}, output: radiance_per_um}, {name: s, response: {band: [1.649 um, 1.651 um]}, output: "
         "radiance_per_um}]}]\n";
}

// Heights along a line as they are, a metre at a time.
TEST(Clouds, ShellsAreWhatLinesPass) {
  std::mt19937 dice(3);
  const auto between = [&](double low, double high) { return low + (high - low) * std::generate_canonical<double, 53>(dice); };
  constexpr double kRadius_m = 6371e3;
  double worst = 0.0;
  for (int n = 0; n < 60; ++n) {
    const double low = between(0.0, 3000.0), high = low + between(10.0, 2000.0), height = between(0.0, 6000.0), sine = std::pow(between(-1.0, 1.0), 3.0),
                 range = between(10.0, 40000.0);
    const double r0 = kRadius_m + height;
    double within = 0.0;
    for (double s = 0.5; s < range; s += 1.0) {
      const double grown = s * (2.0 * r0 * sine + s), h = height + grown / (r0 + std::sqrt(r0 * r0 + grown));
      if (h >= low && h < high) within += 1.0;
    }
    worst = std::max(worst, std::abs(physics::lengthInShell(low, high, height, sine, range, kRadius_m) - within));
  }
  bound("length within shells against a march of 1 m [m]", worst, 2.5, "half a step where a line goes in and out, twice each");
}

TEST(Clouds, HoldWhatTheyAreAskedFor) {
  const Simulation clear = scene(skyScene("clear_us76", 40, 2, 30)),
                   cloudy = scene(skyScene("{library: clear_us76, clouds: [{type: stratus}, {type: cirrus, optical_depth: 0.3}]}", 40, 2, 30)),
                   wet = scene(skyScene("{library: clear_us76, rain: 5 mm/h, clouds: [{type: stratus}]}", 40, 2, 30)),
                   white = scene(skyScene("{library: clear_us76, snow: 1 mm/h}", 40, 2, 30));
  const double radius = clear.frame.earthRadius_m();
  const auto depth = [&](const Simulation& sim, const AirRay& ray, double range_m) {
    return sim.air->opticalDepth(sim.air->node(0.55), sim.air->amounts(ray, range_m));
  };
  const AirRay up{0.0, 1.0, radius}, level{50.0, 0.0, radius}, slant{3000.0, -0.5, radius};
  figure("optical depth of stratus and cirrus over the zenith", depth(cloudy, up, physics::kFar) - depth(clear, up, physics::kFar), 56.9 * 0.67 + 0.3, 1e-4,
         "what is asked; edges of 1 m");
  figure("rain of 5 mm/h along 1 km", depth(wet, level, 1000.0) - depth(clear, level, 1000.0), 0.365 * std::pow(5.0, 0.63), 1e-3,
         "Marshall and Palmer 1948: twice the area of drops");
  figure("visibility in snow of 1 mm/h [km]", 3.912 / (depth(white, level, 1000.0) - depth(clear, level, 1000.0)), 1.29, 0.02, "1.5 R/(rho v r)");
  AirAmounts shells;
  addShells(*cloudy.air, slant, physics::kFar, shells);
  const AirAmounts all = cloudy.air->amounts(slant, physics::kFar);
  double worst = 0.0;
  for (const AirShell& s : cloudy.air->shells()) {
    const auto k = static_cast<size_t>(s.amount);
    worst = std::max(worst, std::abs(all.amount[k] / shells.amount[k] - 1.0));
  }
  bound("amounts of clouds along a slant line, table against closed form, relative", worst, 1e-4, "edges of 1 m on 670 m");
  const auto legs = SunLegs::of(cloudy.air, 0.3, radius);
  worst = 0.0;
  for (double h : {0.0, 200.0, 331.0, 500.0, 990.0, 999.0, 1010.0, 10500.0})
    worst = std::max(worst, std::abs(cloudy.air->opticalDepth(cloudy.air->node(0.55), legs->at(h, 0.3)) - depth(cloudy, {h, 0.3, radius}, physics::kFar)));
  bound("depth to the sun below, in and above clouds, table against the line, of 128", worst, 0.1, "edges of 1 m, of 0.06 each");
}

/// The air of a scene in layers, for its sun, as a walk has it: none of the check's own columns and lines.
PhotonWalk layersOf(const Simulation& sim, double um, double groundAlbedo) {
  const AirNode node = sim.air->node(um);
  const double sine = sim.sun->toSun.z, radius = sim.frame.earthRadius_m();
  std::vector<double> heights;
  for (int k = 0; k <= 160; ++k) heights.push_back(60e3 * std::pow(k / 160.0, 2.5));
  for (const AirShell& s : sim.air->shells())
    for (int k = 0; k <= 200; ++k) heights.push_back(s.low_m + (s.high_m - s.low_m) * k / 200.0);
  std::sort(heights.begin(), heights.end());
  heights.erase(std::unique(heights.begin(), heights.end(), [](double a, double b) { return b - a < 0.01; }), heights.end());
  WalkAir air;
  AirAmounts before;
  std::vector<bool> isShell(kMostAirAmounts, false);
  for (const AirShell& s : sim.air->shells()) isShell[static_cast<size_t>(s.amount)] = true;
  for (size_t n = 0; n < heights.size(); ++n) {
    const AirAmounts up = sim.air->powered(sim.air->amounts({heights[n], 1.0, radius}, physics::kFar));
    air.above.push_back(Atmosphere::depthOf(node, up));
    air.sunlight.push_back(std::exp(-sim.air->opticalDepth(node, sim.air->amounts({heights[n], sine, radius}, physics::kFar))));
    if (n > 0) {
      const double all = air.above[n - 1] - air.above[n];
      double part[3] = {}, most = 0.0;
      air.cloudAsymmetry.push_back(0.0);
      for (size_t a = 0; a < kMostAirAmounts; ++a) {
        const double passed = before.amount[a] - up.amount[a];
        part[0] += node.molecules[a] * passed, part[isShell[a] ? 2 : 1] += node.haze[a] * passed;
        if (!isShell[a] && node.haze[a] > 0.0) air.asymmetry = node.asymmetry[a];
        if (isShell[a] && passed > most) most = passed, air.cloudAsymmetry.back() = node.asymmetry[a];
      }
      air.molecules.push_back(part[0] / all), air.haze.push_back(part[1] / all), air.cloud.push_back(part[2] / all);
    }
    before = up;
  }
  air.groundAlbedo = groundAlbedo;
  air.toSun = {std::sqrt(1.0 - sine * sine), 0.0, sine};
  return PhotonWalk(air);
}

TEST(Clouds, AreWhatPhotonsFind) {
  struct Case {
    const char* what;
    const char* air;
    double sun_deg, height_m, pitch_deg;
  };
  double worst = 0.0;
  for (const Case& c :
       {Case{"overcast from below", "{library: hazy_us76, clouds: [{type: stratus, optical_depth: 12}]}", 40, 10, 60},
        Case{"overcast from below, level", "{library: hazy_us76, clouds: [{type: stratus, optical_depth: 12}]}", 40, 10, 8},
        Case{"cloud from above", "{library: hazy_us76, clouds: [{type: stratocumulus, optical_depth: 20}]}", 25, 5000, -50},
        Case{"within a cloud", "{library: hazy_us76, clouds: [{type: stratus, optical_depth: 6}]}", 50, 700, 20},
        Case{"cirrus", "{library: clear_us76, clouds: [{type: cirrus, optical_depth: 1.5}]}", 35, 10, 50},
        Case{"two clouds", "{library: clear_us76, clouds: [{type: cirrus, optical_depth: 1}, {type: altostratus, optical_depth: 5}]}", 35, 10, 70}}) {
    Simulation sim = scene(skyScene(c.air, c.sun_deg, c.height_m, c.pitch_deg,
                                    "ground: {material: {description: x, source: x, components: [{reflection: lambertian, reflectance: 0.3}]}}\n"));
    std::erase_if(sim.cameras[0].outputs, [](const ChannelOutput& o) { return o.channel == "r"; });
    const Frame frame = renderFrame(sim);
    const double e = c.pitch_deg * kPi / 180.0, a = kPi / 6.0;
    const glm::dvec3 direction(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
    for (const auto& [um, number] : {std::pair{0.55, size_t{0}}, {1.65, size_t{1}}}) {
      const PhotonWalk walk = layersOf(sim, um, 0.3);
      const double above = sim.air->opticalDepth(sim.air->node(um), sim.air->amounts({c.height_m, 1.0, sim.frame.earthRadius_m()}, physics::kFar));
      WalkDice dice(11);
      double sum = 0.0, squares = 0.0, mean = 0.0, error = 1.0;
      constexpr int kMost = 40000, kLook = 2500;
      for (int k = 1; k <= kMost && error > 0.01; ++k) {
        const auto one = walk.from(above, direction, dice);
        const double v = one.once + one.again + one.ground;
        sum += v, squares += v * v;
        if (k % kLook == 0) mean = sum / k, error = std::sqrt((squares / k - mean * mean) / k) / mean;
      }
      const double found = mean * sim.sun->irradiance(um), drawn = at(frame.layers[number], frame, 1, 1);
      std::printf("%s, %g um: drawn %.4g, photons %.4g (%.2f %%), %+.2f %%\n", c.what, um, drawn, found, 100.0 * error, 100.0 * (drawn / found - 1.0));
      worst = std::max(worst, std::abs(drawn / found - 1.0));
    }
  }
  bound("clouds along 12 lines against photons, relative", worst, 0.04, "photons 1 %, at most 1.5; the picture 1 %");
}

// A thick cloud that absorbs nothing lets through K0 / (1.07 + 0.75 (1 - g) depth), K0 = 3/7 (1 + 2 cos), of the sun: asymptotic theory (van de Hulst 1980;
// King 1987, J. Atmos. Sci. 44, 1734; Kokhanovsky et al. 2003). The sky's light on the ground by a quadrature of its lines.
TEST(Clouds, ThickOnesLetThroughWhatTheAsymptoticLawSays) {
  constexpr double um = 0.87;
  double worst = 0.0;
  for (const double depth : {20.0, 60.0}) {
    const Simulation sim =
        scene(skyScene("{library: clear_us76, aerosol: none, clouds: [{type: stratus, optical_depth: " + print("%g", depth) + "}]}", 50, 2, 40));
    Terms terms = termsOf(sim);
    terms.streams = 16;
    const std::vector<SpectralNode> nodes{nodeAt(sim, um)};
    const NodeSpectra spectra(sim, nodes, terms);
    const auto legs = SunLegs::of(sim.air, sim.sun->toSun.z, sim.frame.earthRadius_m());
    const WorldState state = advance(sim, 0.0);
    NodeSum sum(spectra);
    double irradiance = 0.0;
    for (const auto& node : gaussLegendre(6, 0.0, 1.0))
      for (int a = 0; a < 6; ++a) {
        const double azimuth = (a + 0.5) * kPi / 6.0, level = std::sqrt(1.0 - node.x * node.x);
        const glm::dvec3 direction(level * std::sin(azimuth), level * std::cos(azimuth), node.x);
        sum.begin();
        radianceAlong({sim, terms, legs.get(), state, {}}, {{0, 0, 1.0}, direction, castRay(sim, state, {0, 0, 1.0}, direction, 0.1), 0.0}, sum);
        irradiance += node.weight * node.x * sum.radiance()[0] * 2.0 * kPi / 6.0;
      }
    const AirNode node = sim.air->node(um);
    const AirShell shell = sim.air->shells().front();
    const double g = node.asymmetry[static_cast<size_t>(shell.amount)], own = node.extinction[static_cast<size_t>(shell.amount)] * depth;
    const double mu = sim.sun->toSun.z, passed = 3.0 / 7.0 * (1.0 + 2.0 * mu) / (1.07 + 0.75 * (1.0 - g) * own);
    // Gases and molecules above and below take and turn a little.
    const double rest = std::exp(-(sim.air->opticalDepth(node, sim.air->amounts({1001.0, mu, sim.frame.earthRadius_m()}, physics::kFar))));
    const double off = irradiance / (mu * sim.sun->irradiance(um) * rest * passed) - 1.0;
    std::printf("depth %g, g %.4f: %.2f %% off\n", own, g, 100.0 * off);
    worst = std::max(worst, std::abs(off));
  }
  bound("light below a thick cloud against the asymptotic law, relative", worst, 0.05, "K0 to 2 %; molecules above and below, 2 %");
}

}  // namespace
}  // namespace pitviper::test
