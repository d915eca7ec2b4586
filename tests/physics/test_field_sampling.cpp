// How finely pictures look at fields: chosen on few nodes of a plan as on all of them.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/plan/field_sampling.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

// Every wavelength of a band is a node here: 24 of them stand for some hundred. Exhausts seen from aside and from behind, hot and cool, and a burning flare
// with its smoke.
TEST(FieldSampling, FewNodesAskForTheSteps) {
  const std::string world =
      "time: {start: 1 s, rate: 10 Hz, frames: 2}\natmosphere: clear_us76\nsun: {azimuth: 200 deg, elevation: 40 deg, temperature: 5772 K}\n";
  const auto eyes = [](const char* band) {
    return std::string(
               "cameras: [{name: c, film: {width: 32, height: 24, pitch: 15 um}, focal_length: 50 mm, aperture: 25 mm, position: [0 m, 0 m, 900 m], "
               "heading: 90 deg, channels: [{name: a, response: {band: [") +
           band + "]}}]}]\n";
  };
  const std::string along =
                        "plumes: [{name: p, position: [800 m, 0 m, 900 m], direction: [-1, 0.05, 0], length: 25 m, engine: turbofan_military, begin: 0 s}]\n",
                    across = "plumes: [{name: p, position: [800 m, 0 m, 900 m], direction: [0, 1, 0], length: 12 m, engine: turboshaft, begin: 0 s}]\n",
                    burning = "flares: [{name: p, type: mtv, position: [600 m, -9 m, 900 m], speed: 0 m/s, time: 0.2 s}]\n";
  double worst = 0.0;
  int most = 0;
  for (const auto& [field, band] : {std::pair{along, "3.9 um, 4.9 um"}, {across, "3.9 um, 4.9 um"}, {across, "8 um, 12 um"}, {burning, "3.9 um, 5 um"}}) {
    const Simulation sim = scene(world + field + eyes(band));
    SpectralSampling every;
    every.reference = true;
    Plan plan = makePlan(sim, sim.cameras[0].outputs, every, {});
    plan.accuracy = 0.01;
    ASSERT_GT(plan.nodeCount(), 4 * 24);
    const FieldSampling few(sim, plan, 24), all(sim, plan, plan.nodeCount());
    for (std::size_t f = 0; f < sim.fields.size(); ++f)
      for (double time_s : field == burning ? std::vector{1.0, 1.1} : std::vector{1.0}) {  // exhausts are as they were
        const StepsByKind some = few.steps(f, time_s), every_ = all.steps(f, time_s);
        for (std::size_t k = 0; k < some.size(); ++k) {
          EXPECT_EQ(some[k] == 0, every_[k] == 0) << f << " " << k;
          if (every_[k] > 0 && some[k] > 0) worst = std::max(worst, std::abs(std::log(static_cast<double>(some[k]) / every_[k])));
          most = std::max(most, every_[k]);
        }
        const ApartByKind own = few.coarser(f, time_s), apart = all.coarser(f, time_s);
        for (std::size_t k = 0; k < own.size(); ++k) {
          EXPECT_LE(own[k], 1.5 * apart[k]) << f << " " << k << ": a neighbour in the list of distances";
          EXPECT_GE(own[k], apart[k] / 2.1) << f << " " << k << ": two of them";
        }
      }
  }
  EXPECT_GT(most, 8) << "there is something to choose";
  bound("steps of fields by 24 nodes of hundreds against those by all, logarithm of their ratio", worst, 0.7, "1 and 2, neighbours in the list of counts");
}

}  // namespace
}  // namespace pitviper::test
