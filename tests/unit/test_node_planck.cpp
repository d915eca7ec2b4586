// Black bodies at nodes in vectors: Planck's law one by one, and its rise by differences of it.
#include <gtest/gtest.h>

#include "sim/radiance/node_planck.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

TEST(NodePlanck, IsPlancksLawAndItsSlope) {
  std::vector<SpectralNode> nodes(3);
  nodes[0].members = {{0.5, 1.0}};
  nodes[1].members = {{3.0, 0.25}, {4.5, 0.75}};
  nodes[2].members = {{8.0, 0.2}, {14.0, 0.3}, {100.0, 0.5}};
  const NodePlanck planck(nodes);
  double worst = 0.0, worstRise = 0.0;
  for (const double t : {150.0, 300.0, 1000.0, 3000.0}) {
    std::vector<double> radiance(3), rise(3);
    planck.at(t, radiance, rise);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const auto mean = [&](double kelvin) { return nodes[n].mean([&](double um) { return physics::planckRadiance(um, kelvin); }); };
      worst = std::max(worst, std::abs(radiance[n] / mean(t) - 1.0));
      const double h = 1e-4 * t;
      worstRise = std::max(worstRise, std::abs(rise[n] * 2.0 * h / (mean(t + h) - mean(t - h)) - 1.0));
    }
  }
  bound("black bodies at nodes against Planck's law", worst, 1e-12, "the same law in double, exp(-x) to x = 192");
  // (c2 / (lambda T))^2 h^2 / 6 of the third derivative, 192 at 0.5 um and 150 K.
  bound("their rise against differences of it", worstRise, 192.0 * 192.0 * 1e-8 / 6.0 * 2.0, "central differences over 1e-4 of the temperature");
}

}  // namespace
}  // namespace pitviper::test
