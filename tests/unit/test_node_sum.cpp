// Sums over nodes: their table of black bodies, and segments of air and gas against closed forms.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "sim/plan/plan.hpp"
#include "sim/radiance/node_sum.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// A scenario must have one.
constexpr const char* kCamera =
    "cameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 1 mm, look_at: [1 m, 0 m, 0 m], channels: [{name: a, response: {band: "
    "[0.6 um, 0.7 um]}}]}]\n";

TEST(NodeSum, BlackBodiesOfAirAreThoseOfPlancksLaw) {
  const Simulation sim = scene(std::string("atmosphere: clear_us76\n") + kCamera);
  for (const auto& [wavelength_um, tolerance] : {std::pair{1.0, 1e-4}, {3.0, 2e-6}, {4.0, 5e-7}, {10.0, 1e-8}}) {
    const std::vector<SpectralNode> nodes = {nodeAt(sim, wavelength_um)};
    const NodeSpectra spectra(sim, nodes);
    double worst = 0.0, value = 0.0;
    for (double t = 180.13; t < 330.0; t += 0.37) {
      spectra.planck(t, {&value, 1});
      worst = std::max(worst, std::abs(value / physics::planckRadiance(wavelength_um, t) - 1.0));
    }
    bound("table of black bodies at " + print("%g", wavelength_um) + " um, 180 to 330 K, relative", worst, tolerance,
          "cubic with slopes: (dln B/dT)^4 / 384 at 180 K");
  }
}

/// Air and a gas of constant properties on one segment, told by hand.
struct OneSegment {
  Simulation sim = scene(std::string("atmosphere: {extinction: 0.3 /km, temperature: 280 K}\nmaterials: {gas: {absorption: 0.002 /m}}\n"
                                     "entities: [{name: b, shape: {model: sphere, radius: 1 m}, material: gas, temperature: 900 K}]\n") +
                         kCamera);
  std::vector<SpectralNode> nodes = {nodeAt(sim, 4.0), nodeAt(sim, 10.0)};
  NodeSpectra spectra{sim, nodes};
};

// Law: J (1 - exp(-(x + y))) with J = (x S + y B) / (x + y); then again through what the first segment leaves.
TEST(NodeSum, AirAndGasOnOneSegment) {
  OneSegment one;
  NodeSum sum(one.spectra);
  sum.keepParts();
  const auto gas = std::find_if(one.sim.materials.begin(), one.sim.materials.end(), [](const auto& m) { return m->medium.has_value(); });
  const MediumInside inside{&*(*gas)->medium, 0, static_cast<int>(gas - one.sim.materials.begin()), 900.0, 400.0};
  AirPlace near, far;
  far.range_m = 400.0, far.powered.amount[0] = 400.0;
  sum.begin();
  sum.segment({near, far, {&inside, 1}, true, false, 0.0, false});
  const double y = 0.3e-3 * 400.0, x = 0.002 * 400.0, lost = -std::expm1(-(x + y));
  for (size_t i = 0; i < 2; ++i) {
    const double w = one.nodes[i].members.front().wavelength_um, s = physics::planckRadiance(w, 900.0), b = physics::planckRadiance(w, 280.0);
    figure("400 m of gas in air at " + print("%g", w) + " um [W/(m2 sr um)]", sum.radiance()[i], (x * s + y * b) / (x + y) * lost, 1e-12,
           "(x S + y B)(1 - exp(-x - y)) / (x + y)");
    EXPECT_NEAR(sum.part(TermKind::Media)[i] + sum.part(TermKind::AirEmission)[i], sum.radiance()[i], 1e-12 * sum.radiance()[i]);
    EXPECT_NEAR(sum.transmittance()[i], std::exp(-x), 1e-12);
  }
  // A black body behind.
  const std::array behind{Factor::planck(600.0, true)};
  const std::vector<double> before(sum.radiance().begin(), sum.radiance().end());
  sum.term({TermKind::Emission, 0.5, behind, nullptr});
  for (size_t i = 0; i < 2; ++i) {
    const double w = one.nodes[i].members.front().wavelength_um;
    EXPECT_NEAR(sum.radiance()[i] - before[i], 0.5 * physics::planckRadiance(w, 600.0) * std::exp(-x - y), 1e-12 * sum.radiance()[i]);
  }
}

// A gas whose source rises evenly with depth from its near end to its far one: int (S + D (t/d - 1/2)) exp(-t) dt from 0 to d, by Simpson's rule here; depths
// from thin to opaque, hotter far away and near by.
TEST(NodeSum, SourceThatChangesOverASegment) {
  OneSegment one;
  const auto gas = std::find_if(one.sim.materials.begin(), one.sim.materials.end(), [](const auto& m) { return m->medium.has_value(); });
  double worst = 0.0;
  for (double d : {1e-4, 0.1, 1.0, 5.0, 30.0})
    for (double drift_perK : {-1e-4, 1e-4}) {
      MediumInside inside{&*(*gas)->medium, -1, static_cast<int>(gas - one.sim.materials.begin()), 900.0, d / 0.002, false};
      inside.drift_perK = drift_perK;
      NodeSum sum(one.spectra);
      sum.begin();
      AirPlace near, far;
      far.range_m = 400.0;
      sum.segment({near, far, {&inside, 1}, false, false, 0.0, false});
      for (size_t i = 0; i < 2; ++i) {
        const double w = one.nodes[i].members.front().wavelength_um, s = physics::planckRadiance(w, 900.0);
        const double more =
            physics::planckRadiance(w, 1.0 / (1.0 / 900.0 + 0.5 * drift_perK)) - physics::planckRadiance(w, 1.0 / (1.0 / 900.0 - 0.5 * drift_perK));
        constexpr int kParts = 20000;
        double want = 0.0;
        for (int k = 0; k <= kParts; ++k) {
          const double t = d * k / kParts, weight = k == 0 || k == kParts ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
          want += weight * (s + more * (t / d - 0.5)) * std::exp(-t) * d / (3.0 * kParts);
        }
        worst = std::max(worst, std::abs(sum.radiance()[i] / want - 1.0));
      }
    }
  bound("gas whose source changes over a segment, depths 1e-4 to 30", worst, 1e-6, "black bodies by a table of 5 K: cubic with slopes; Simpson's rule");
}

}  // namespace
}  // namespace pitviper::test
