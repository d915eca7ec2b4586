// Whether wavelengths do for a gas: a band far narrower than their distance, and one that they resolve.
#include <gtest/gtest.h>

#include "sim/plan/sampling_check.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::vector<SamplingNote> notesOf(const std::string& absorption, int samples, const std::string& temperature = "900 K") {
  const Simulation sim =
      scene("materials: {gas: {absorption: " + absorption +
            "}}\nentities: [{name: s, shape: {model: sphere, radius: 1 m}, material: gas, temperature: " + temperature +
            "}]\ncameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 5 deg, aperture: 40 mm, look_at: s, position: [9 m, 0 m, 0 m], "
            "spectral: {samples: " +
            std::to_string(samples) + "}, channels: [{name: b, response: {band: [3 um, 5 um]}}]}]\n");
  const Camera& c = sim.cameras[0];
  return checkSampling(sim, makePlan(sim, c.outputs, c.spectral, c.where), c.outputs, 0.01);
}

constexpr const char* kLine = "{wavelength: um, unit: 1/m, values: [[2.9, 0], [4.23, 0], [4.3, 2], [4.37, 0], [5.1, 0]]}";

TEST(SamplingCheck, TellsALineThatFallsBetweenTheSamples) {
  const auto notes = notesOf(kLine, 16);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].medium, "gas");
  EXPECT_EQ(notes[0].channel, "b");
  EXPECT_GT(notes[0].error, 0.2);  // a triangle of 140 nm, samples 60 to 190 nm apart; a line narrower than half their distance has nodes of its own
}

TEST(SamplingCheck, IsContentWithWhatIsResolved) {
  EXPECT_TRUE(notesOf(kLine, 512).empty());
  EXPECT_TRUE(notesOf("{wavelength: um, unit: 1/m, values: [[2.9, 0.1], [5.1, 0.4]]}", 16).empty());
  EXPECT_TRUE(notesOf("0.2 /m", 4).empty());
  EXPECT_TRUE(notesOf(kLine, 16, "50 K").empty());  // it does not shine
}

}  // namespace
}  // namespace pitviper::test
