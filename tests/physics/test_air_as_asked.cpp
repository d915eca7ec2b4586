// Library air with what a scenario says of it; responses that go on beyond it; how frames say in which mode they were drawn.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

Simulation wall(const std::string& air, const std::string& more = "", const std::string& response = "{band: [0.5 um, 0.7 um]}") {
  return scene(
      "atmosphere: " + air + "\n" + more +
      "materials: {m: {}}\nentities: [{name: wall, shape: {model: plate, width: 2 km, height: 2 km}, material: m, temperature: 1500 K, heading: 180 deg, "
      "position: [0 m, 5 km, 50 m]}]\n"
      "cameras: [{name: c, film: {width: 2, height: 2}, field_of_view: 0.1 deg, aperture: 5 mm, position: [0 m, 0 m, 50 m], look_at: wall, "
      "channels: [{name: b, response: " +
      response + "}]}]\n");
}

double radiance(const Simulation& sim) {
  const Frame f = renderFrame(sim);
  return at(layer(f, "b.radiance"), f, 0, 0);
}

std::string attribute(const Frame& f, const std::string& name) {
  for (const auto& a : f.attributes)
    if (a.name == name) return std::get<std::string>(a.value);
  return "";
}

// Rationale: 'aerosol: table' in a clear library air stayed clear. Expected: the hazy air of the same table, to the last bit; 'none' in a hazy one the
// clear one; the library's own word where the scenario says nothing.
TEST(AirAsAsked, AerosolOfTheTable) {
  for (const std::string name : {"us76", "mls"}) {
    const double clear = radiance(wall("clear_" + name)), hazy = radiance(wall("hazy_" + name));
    EXPECT_GT(clear, 1.5 * hazy);  // 23 km of visibility: exp(-5 x 3.912 / 23) and molecules
    EXPECT_EQ(radiance(wall("{library: clear_" + name + ", aerosol: table}")), hazy);
    EXPECT_EQ(radiance(wall("{library: hazy_" + name + ", aerosol: none}")), clear);
    EXPECT_EQ(radiance(wall("{library: hazy_" + name + ", aerosol: table}")), hazy);
    EXPECT_LT(radiance(wall("{library: clear_" + name + ", visibility: 5 km}")), 0.5 * hazy);
    EXPECT_EQ(radiance(wall("{library: clear_" + name + ", visibility: 5 km, aerosol: table}")),
              radiance(wall("{library: hazy_" + name + ", visibility: 5 km}")));
  }
}

// The library's microbolometer in the library's air is the same as its product with a band that ends where the air does; the frame says what is left out.
TEST(AirAsAsked, AResponseCutAtTheAirsEnd) {
  const Simulation cut = wall("hazy_us76", "accuracy: 1 %\n", "microbolometer_lwir");
  char band[120];
  std::snprintf(band, sizeof band, "{product: [microbolometer_lwir, {band: [1 um, %.17g um]}]}", cut.air->validHigh_um());
  const Frame a = renderFrame(cut), b = renderFrame(wall("hazy_us76", "accuracy: 1 %\n", band));
  EXPECT_NEAR(at(layer(a, "b.radiance"), a, 0, 0) / at(layer(b, "b.radiance"), b, 0, 0), 1.0, 1e-6);
  EXPECT_NE(attribute(a, "pitviper.response_cut.b.radiance").find("is left out"), std::string::npos);
  EXPECT_EQ(attribute(b, "pitviper.response_cut.b.radiance"), "");
}

TEST(AirAsAsked, FramesSayTheirMode) {
  EXPECT_EQ(attribute(renderFrame(wall("none", "accuracy: reference\n")), "pitviper.mode"), "reference");
  EXPECT_EQ(attribute(renderFrame(wall("none", "accuracy: 1 %\n")), "pitviper.mode"), "planned");
  EXPECT_EQ(attribute(renderFrame(wall("none")), "pitviper.mode"), "sampled");
  EXPECT_EQ(attribute(renderFrame(wall("clear_us76")), "pitviper.mode"), "planned");
}

// A band that ends at the very end of the spectral axis is taken, and holds what Planck's law has in it.
TEST(AirAsAsked, ABandToTheEndOfTheAxis) {
  const Simulation sim = wall("none", "", "{band: [200 um, 1000 um]}");
  EXPECT_EQ(sim.cameras.at(0).outputs.at(0).kernel.supportHigh(), 1000.0);
  // Planck's law by the rule of midpoints, error 1e-8 (the series of blackBodyBand() takes thousands of terms here); 16 Gauss points, single precision.
  double expected = 0.0;
  constexpr int kSteps = 40000;
  for (int k = 0; k < kSteps; ++k) {
    const double um = 200.0 + 800.0 * (k + 0.5) / kSteps;
    expected += 800.0 / kSteps * 1.191042972e8 / std::pow(um, 5) / std::expm1(14387.76877 / (um * 1500.0));
  }
  EXPECT_NEAR(radiance(sim) / expected, 1.0, 1e-5);
  EXPECT_EQ(wall("none", "", "{band: [0.1 um, 1 um]}").cameras.at(0).outputs.at(0).kernel.supportLow(), 0.1);
  EXPECT_EQ(wall("none", "", "{band: [100 nm, 1 mm]}").cameras.at(0).outputs.at(0).kernel.supportHigh(), 1000.0);
}

}  // namespace
}  // namespace pitviper::test
