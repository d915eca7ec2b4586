// Haze as thick as fog is said to be haze, by how much fogs differ; clear air and air of a mile are not.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/world/haze_not_fog.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

Simulation airOf(const std::string& air) {
  return scene("atmosphere: " + air +
               "\nprobes: [{name: p, position: [0 m, 0 m, 1 m], channels: [{name: a, response: {band: [8 um, 12 um]}, output: irradiance}]}]\n");
}

TEST(HazeNotFog, IsSaidBelowAKilometre) {
  for (double km : {0.5, 0.62, 0.8, 0.95})
    for (const char* library : {"hazy_us76", "hazy_mls"}) {
      const Simulation sim = airOf("{library: " + std::string(library) + print(", visibility: %g km}", km));
      const auto* hazy = dynamic_cast<const HasHaze*>(sim.air.get());
      ASSERT_NE(hazy, nullptr);
      figure(std::string(library) + print(", haze of %g km at 0.55 um [1/km]", km), hazy->hazePer_km(0.55), 3.912 / km - 0.0116, 4e-3,
             "Koschmieder's law less Rayleigh scattering; read between bins of the table");
      const std::string words = hazeNotFog(sim);
      EXPECT_NE(words.find(print("air of %.2g km of visibility is haze here, not fog", km)), std::string::npos) << words;
      // By Beer's law of LOWTRAN 7's ratios.
      EXPECT_NE(words.find(print("of such fogs %.2g to ", 100.0 * std::exp(-0.24139 * hazy->hazePer_km(0.55)))), std::string::npos) << words;
      EXPECT_LT(hazy->hazePer_km(10.0) / hazy->hazePer_km(0.55), 0.15);  // rural haze at 70 % of humidity: 0.07 (Shettle and Fenn 1979)
      if (km == 0.8) std::printf("%s\n", words.c_str());
    }
}

TEST(HazeNotFog, IsNotSaidOfOtherAir) {
  for (const char* air : {"{library: hazy_us76, visibility: 1 km}", "{library: hazy_us76, visibility: 2 km}", "hazy_us76", "hazy_mls", "clear_us76",
                          "clear_mls", "{model: homogeneous, extinction: 5e-3 /m}"})
    EXPECT_EQ(hazeNotFog(airOf(air)), "") << air;
  const Simulation none;
  EXPECT_EQ(hazeNotFog(none), "");
}

}  // namespace
}  // namespace pitviper::test
