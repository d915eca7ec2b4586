// What lamps are left out by: no lobe times the cosine of its light is above the greatest that it says it can be.
#include <gtest/gtest.h>

#include "tests/support/figures.hpp"
#include "tests/support/hemisphere.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

TEST(Lobes, StayBelowTheirMaximum) {
  std::vector<std::string> components;
  for (double width : {0.02, 0.1, 0.3}) {
    components.push_back(print("{reflection: microfacet, index: aluminium, roughness: %g}", width));
    components.push_back(print("{reflection: microfacet, index: 1.5, roughness: %g, slopes: normal, pigment: 0.5}", width));
    components.push_back(print("{reflection: ward, reflectance: 0.5, roughness: %g}", width));
    components.push_back(print("{reflection: sandford_robertson, emissivity: 0.5, diffuse: 0.2, grazing: 0.3, width: %g}", width));
    components.push_back(print("{reflection: beard_maxwell, n: 1.5, scan: 0.0004, width: %g, tau: 30 deg, omega: 40 deg}", width));
    components.push_back(print("{reflection: phong, reflectance: 0.5, exponent: %g}", 1.0 / (width * width)));
  }
  components.push_back("{reflection: sea, wind: 5 m/s}");
  double worst = 0.0;
  for (const std::string& component : components) {
    const Simulation sim =
        scene("materials: {m: {components: [" + component +
              "]}}\ncameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 20 mm, position: [1 m, 0 m, 0 m], look_at: "
              "[0 m, 0 m, 0 m], channels: [{name: v, response: {band: [0.6 um, 0.62 um]}}]}]\n");
    for (const auto& r : sim.materials.front()->reflections)
      // Mirrored directions, and others near them: where lobes are greatest.
      for (int v = 0; v < 179; ++v)
        for (int off = -8; off <= 8; ++off) {
          const double view = 0.5 * v * kPi / 180.0, light = view + 0.2 * off * kPi / 180.0;
          if (light < 0.0 || light > 89.4 * kPi / 180.0 || view > 89.4 * kPi / 180.0) continue;
          const double seen = std::cos(light) * r->lobeAt({-std::sin(light), 0.0, std::cos(light)}, {std::sin(view), 0.0, std::cos(view)});
          worst = std::max(worst, seen / r->lobe().maximum);
        }
  }
  EXPECT_GT(worst, 0.3);
  bound("lobes times the cosine of their light over the greatest they say, down to 0.6 deg above the horizon", worst, 1.0 + 1e-9,
        "what lamps are left out by; rounding");
}

}  // namespace
}  // namespace pitviper::test
