// Corners of transparent surfaces and media where a plausible shortcut would go wrong: bodies that nearly touch, concave ones, probes, small
// solids behind something.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/fog_world.hpp"

namespace pitviper::test {
namespace {

// Two spheres that nearly touch, turned so that the corners of the boxes around them overlap: the spheres don't.
TEST(Corners, SpheresThatNearlyTouch) {
  for (double heading : {70.0, 90.0, 110.0}) {
    World w{.eye = {{0, 0, 0}, {1, 0, 0}, 12.0, 96}, .background_K = 260.0};
    w.clouds = {of(placed(sphere(1), {20.4, -0.92, 0}, heading), 0.6, 500), of(placed(sphere(1), {19.6, 0.92, 0}, heading), 0.6, 300)};
    bound("spheres that nearly touch, turned to " + text(heading) + " deg, worst pixel", w.worst(), 1e-4, "march; short chords at the rims");
  }
}

// Air between the arms of a U is not inside it.
TEST(Corners, ConcaveBodyInAir) {
  const TemporaryFolder folder;
  World w{.extinction = 0.2, .air_K = 280};
  w.walls = {{.x = 30, .kelvin = 350}};
  w.clouds = {of(placed(uShape(folder), {15, -1.5, -0.5}, 90, 0), 1.0, 450)};
  bound("U in air, rays through both arms, worst pixel", w.worst(), 0.02,
        "air is spread evenly from the first entry to the last exit: second order in the optical depths");
}

// What is seen in a probe's hemisphere, too: a plate above it, and a pane or a medium between.
TEST(Corners, ProbeBehindAPaneAndAMedium) {
  const std::string probe =
      "probes: [{name: s, position: [0 m, 0 m, 0 m], normal: [0, 0, 1], resolution: 128, channels: [{name: lw, response: {band: [8 um, 12 um]}, output: "
      "irradiance}]}]\n";
  auto ceiling = [](const std::string& name, double z, const std::string& rest) {
    return "  - {name: " + name + ", shape: {model: plate, width: 4 km, height: 4 km}, heading: 0 deg, pitch: 90 deg, position: [0 m, 0 m, " + text(z) +
           " m], " + rest + "}\n";
  };
  const std::string warm = ceiling("top", 1.0, "material: blackbody, temperature: 400 K");
  const double open = probeReading(scene("entities:\n" + warm + probe))[0];
  const double pane =
      probeReading(scene("entities:\n" + warm + ceiling("pane", 0.5, "material: {transmission: {transmittance: 0.4}}, temperature: 300 K") + probe))[0];
  figure("probe under a pane [W/m2]", pane, 0.4 * open + 0.6 * open * B(300) / B(400), 1e-3, "T B + (1 - T) B(pane) over the hemisphere");
  const double fog = probeReading(scene(
      "entities:\n" + warm +
      "  - {name: c, shape: {model: sphere, radius: 0.3 m}, material: {absorption: 50 /m}, temperature: 300 K, position: [0 m, 0 m, 0.6 m]}\n" + probe))[0];
  const double solid = probeReading(
      scene("entities:\n" + warm +
            "  - {name: c, shape: {model: sphere, radius: 0.3 m}, material: blackbody, temperature: 300 K, position: [0 m, 0 m, 0.6 m]}\n" + probe))[0];
  figure("probe under an opaque medium, against a solid sphere [W/m2]", fog, solid, 3e-3, "a medium of depth 30 is a black body but for its rim");
}

// A solid smaller than a pixel keeps the intensity that comes through what stands before it.
TEST(Corners, SmallSolidBehindAPaneAndInAMedium) {
  for (double range : {200.0, 2000.0, 20000.0}) {
    const Eye eye{{0, 0, 0}, {1, 0, 0}, 1.0, 16};
    const std::string place = ", position: " + text(glm::dvec3(range, 0.13, 0.07)), size = text(8.0 * range) + " m";
    const std::string target = "  - {name: t, shape: {model: plate, width: 1 m, height: 1 m}, material: blackbody, temperature: 500 K" + place + "}\n";
    const std::string pane = "  - {name: w, shape: {model: plate, width: " + size + ", height: " + size +
                             "}, material: {transmission: {transmittance: 0.3}}, temperature: 300 K, position: " + text(glm::dvec3(0.5 * range, 0, 0)) + "}\n";
    const std::string fog = of(placed(sphere(0.4 * range), {range, 0, 0}), 2.0 / range, 350).yaml("m");
    auto flux = [&](const std::string& entities) {
      return sum(layer(renderFrame(scene("background: {temperature: 280 K}\nentities:\n" + entities +
                                         eye.yaml("[{name: lw, response: {band: [8 um, 12 um]}, output: irradiance}]"))),
                       "lw.irradiance"));
    };
    const double seen = 1.0 / (range * range);
    figure("1 m2 plate at " + text(range) + " m behind a pane, contrast [W/m2]", flux(pane + target) - flux(pane), 0.3 * (B(500) - B(280)) * seen, 2e-3,
           "T (B - B_behind) A/R2; silhouette; difference of two pictures in single precision");
    // Before it 0.4 R of the medium, as much behind.
    figure("1 m2 plate at " + text(range) + " m in a medium, contrast [W/m2]", flux(fog + target) - flux(fog),
           std::exp(-0.8) * (B(500) - (B(350) * -std::expm1(-0.8) + B(280) * std::exp(-0.8))) * seen, 2e-3, "exp(-k s) (B - L of what the plate hides) A/R2");
  }
}

}  // namespace
}  // namespace pitviper::test
