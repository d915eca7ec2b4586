// Transparent surfaces and media where simpler ways go wrong: order, the near plane, far places, lights and targets smaller than a pixel.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/fog_world.hpp"

namespace pitviper::test {
namespace {

// The middle ray runs exactly along the axis, parallel to the whole side: the quadratic of the side has no square and no linear term.
TEST(TransparentTraps, CylinderExactlyAlongItsAxis) {
  for (double heading : {90.0, 270.0}) {
    World w{.eye = {{0, 0, 0}, {1, 0, 0}, 1.0, 9}};
    w.clouds = {of(placed(cylinder(1, 4), {20, 0, 0}, heading), 0.3)};
    bound("cylinder exactly along its axis, heading " + text(heading) + ", worst pixel", w.worst(), 1e-5, "slab equation");
  }
}

// A long oblique plume and something half over its side, behind its near end or before its far one: the plume's outline is narrow, the
// rectangle around it is not. At the middle of what the other shares with that rectangle the plume is not even hit.
const glm::dvec3 kPlumeAxis = axesOf(130.0, -25.0)[0];  // (0.69, -0.58, -0.42): from (20, 9, 6) to (40, -9, -6)
const Cloud kPlume = of(placed(cylinder(0.6, 30), {30, 0, 0}, 130.0, -25.0), 0.8, 500);

TEST(TransparentTraps, PaneOverTheSideOfAnObliquePlume) {
  World alone{.eye = {{0, 0, 0}, {1, 0, 0}, 50.0, 48}, .background_K = 260.0};
  alone.clouds = {kPlume};
  bound("oblique plume alone, worst pixel", alone.worst(), 5e-4,
        "short chords at the rim: a way of 1 cm in a body of 30 m, 14 times brighter than what is behind");
  for (double end : {-1.0, 1.0}) {
    World w{.eye = {{0, 0, 0}, {1, 0, 0}, 50.0, 48}, .background_K = 260.0, .wallSize = 40.0};
    w.clouds = {kPlume};
    const glm::dvec3 p = kPlume.place + end * 11.0 * kPlumeAxis;
    // 1.5 m off in depth the plume's middle has moved by 1.3 m: the pane stays clear of it.
    w.walls = {{.x = p.x - 1.5 * end, .transmittance = 0.4, .kelvin = 350, .low = end < 0 ? p.y + 0.2 : p.y - 4.0, .high = end < 0 ? p.y + 4.0 : p.y - 0.2}};
    bound(std::string("pane ") + (end < 0 ? "behind the near" : "before the far") + " end of an oblique plume, worst pixel", w.worst(), 5e-4,
          "march; short chords at the rim");
  }
}

TEST(TransparentTraps, SphereOverTheSideOfAnObliquePlume) {
  for (double end : {-1.0, 1.0}) {
    World w{.eye = {{0, 0, 0}, {1, 0, 0}, 50.0, 64}, .background_K = 260.0};
    w.clouds = {kPlume, of(sphere(1.0), 1.5, 300)};
    const glm::dvec3 p = kPlume.place + end * 11.0 * kPlumeAxis, away = glm::normalize(p);
    // Off in depth and aside, its middle 1.75 m from the plume's: 0.15 m between them.
    const glm::dvec3 across = glm::normalize(glm::cross(kPlumeAxis, away)), off = glm::normalize(glm::cross(across, kPlumeAxis));
    w.clouds[1].place = p + 1.3 * across + (glm::dot(off, away) * end < 0 ? 1.0 : -1.0) * 1.17 * off;
    bound(std::string("sphere ") + (end < 0 ? "behind the near" : "before the far") + " end of an oblique plume, worst pixel", w.worst(), 5e-4,
          "march; short chords at the rims");
  }
}

// Beside a cone's slender end, within the box around it but outside the cone, and behind its wide end.
TEST(TransparentTraps, BehindTheWideEndOfACone) {
  World w{.eye = {{0, 0, 0}, {1, 0, 0}, 12.0, 48}, .background_K = 260.0};
  w.clouds = {of(placed(cone(1.5, 0, 3), {20, 0, 0}), 2.0, 500), of(placed(sphere(0.3), {19.8, 1.25, 0}), 3.0, 300)};
  bound("sphere behind the wide end of a cone, worst pixel", w.worst(), 1e-4, "march; short chords at the rims");
  w.clouds.pop_back();
  w.walls = {{.x = 19.5, .transmittance = 0.3, .kelvin = 300, .low = 1.05}};
  bound("pane behind the wide end of a cone, worst pixel", w.worst(), 1e-4, "march; short chords at the rims");
}

// A meshed body is filled up to the camera, as the same body in its true form is.
TEST(TransparentTraps, CameraInsideAMesh) {
  World w{.eye = {{0, 0, 0}, {1, 0.2, 0.1}, 90.0, 24}, .background_K = 300.0};
  w.clouds = {of(placed(box(6, 5, 4), {0.4, -0.3, 0.5}, 55, 10), 0.3)};
  bound("camera inside a box, worst pixel", w.worst(), 1e-5, "from the camera to where the ray leaves");
  // A side of it between the camera and the near plane.
  w.eye = {{0, 0, 0}, {1, 0, 0}, 40.0, 24};
  for (double x : {3.2, 3.05, 3.0001, 2.95, -2.95}) {
    w.clouds = {of(placed(box(6, 50, 50), {x, 0, 0}), 0.05)};
    bound("box of 6 m around " + text(x) + " m, worst pixel", w.worst(), 1e-5, "from the camera, or where the ray enters, to where it leaves");
    w.clouds = {of(placed(cylinder(25, 6), {x, 0, 0}), 0.05)};
    bound("cylinder of 6 m around " + text(x) + " m, worst pixel", w.worst(), 1e-5, "from the camera, or where the ray enters, to where it leaves");
  }
}

// A plate inside a far medium, with another medium near the camera: places are compared around one common middle.
TEST(TransparentTraps, SolidInsideAFarMediumAndANearOne) {
  for (bool nearLast : {true, false}) {
    const double range = 2e6 + 0.37;
    World w{.eye = {{0, 0, 0}, {1, 0, 0}, 12.0 / range * 180.0 / kPi, 24}, .background_K = 260.0, .wallSize = 40.0};
    w.clouds = {of(placed(sphere(5), {range, 0, 0}), 0.1), of(placed(sphere(0.3), {5, 0, 0}), 0.2, 330)};
    if (!nearLast) std::swap(w.clouds[0], w.clouds[1]);
    w.walls = {{.x = range + 1.03, .kelvin = 330, .low = 0.0}};
    bound(std::string("plate inside a sphere at 2000 km, ") + (nearLast ? "near medium listed last" : "near medium listed first") + ", worst pixel", w.worst(),
          1e-4, "chord from differences at the body");
  }
}

// --- lights and small bodies ---------------------------------------------------------------------------------------------------------

/// On the aperture, summed in double precision: a faint body must not drown in a frame's rounding.
double irradiance(const std::string& yaml) {
  const CameraImage image = renderImage(scene(yaml));
  const auto& slot = image.slots[static_cast<size_t>(image.slotOfOutput[0])];
  double total = 0.0;
  for (size_t p = 0; p < slot.size(); ++p) total += slot[p] * image.solidAngles->projected_sr[p];
  return total;
}
const std::string kIrradiance = "[{name: lw, response: {band: [8 um, 12 um]}, output: irradiance}]";

// Flux of a light that is seen through something: I T tau cos/R2 per area of the aperture; what shines besides is left out by difference.
TEST(TransparentTraps, VisibleLightBehindTransparentThings) {
  const double g = 0.01, range = 30.0, oblique = std::sqrt(range * range + 1.0);
  const Eye eye{{0, 0, 0}, {1, 0, 0}, 6.0, 9};
  const std::string air = "atmosphere: {extinction: 10 /km}\n";
  auto light = [&](double level) { return "lights: [{name: l, intensity: " + text(900.0 * level) + " W/(sr um), position: [30 m, 1 m, 0 m]}]\n"; };
  auto pane = [](const std::string& name, double x, double t) {
    return "  - {name: " + name + ", shape: {model: plate, width: 20 m, height: 20 m}, material: {transmission: {transmittance: " + text(t) +
           "}}, temperature: 300 K, position: [" + text(x) + " m, 0 m, 0 m]}\n";
  };
  const double open = 900.0 * 4.0 * std::exp(-g * oblique) / (oblique * oblique) * range / oblique;
  auto through = [&](const std::string& entities) {
    const std::string rest = "entities:\n" + entities + eye.yaml(kIrradiance, "    small_bodies: 0\n");
    return irradiance(air + light(1.0) + rest) - irradiance(air + light(1e-30) + rest);
  };
  const std::string why = "I T tau cos/R2; difference of two pictures in single precision";
  figure("light before a pane [W/m2]", through(pane("a", 35, 0.4)), open, 1e-5, why);
  figure("light behind a pane [W/m2]", through(pane("a", 10, 0.4)), 0.4 * open, 1e-5, why);
  figure("light behind two panes [W/m2]", through(pane("a", 10, 0.4) + pane("b", 20, 0.25) + pane("c", 31, 0.1)), 0.1 * open, 1e-5, why);
  // Media: through the whole of one, from within one, a meshed one.
  const Line ray{{0, 0, 0}, glm::normalize(glm::dvec3(30, 1, 0))};
  Cloud ball = of(placed(sphere(2), {15, 0.2, 0}), 0.5), brick = of(placed(box(4, 4, 4), {15, 0.2, 0}, 60, 20), 0.3),
        around = of(placed(sphere(5), {30, 0, 0}), 0.2);
  figure("light behind a sphere of gas [W/m2]", through(ball.yaml("c")), open * std::exp(-ball.depthOf(ray)), 1e-4, why);
  figure("light behind a box of gas [W/m2]", through(brick.yaml("c")), open * std::exp(-brick.depthOf(ray)), 1e-4, why);
  const auto inside = around.stretches(ray);
  figure("light inside a sphere of gas [W/m2]", through(around.yaml("c")), open * std::exp(-0.2 * (oblique - inside[0].enter)), 1e-4, why);
  figure("light behind a pane and a sphere of gas [W/m2]", through(pane("a", 20, 0.4) + ball.yaml("c")), 0.4 * open * std::exp(-ball.depthOf(ray)), 1e-4, why);
}

// Contrast intensity of a small sphere of gas: (B - B_behind) pi r2 (1 - 2/x2 (1 - (1 + x) exp(-x))), x = 2 k r: the mean of 1 - exp(-k s) over its disc.
TEST(TransparentTraps, SmallMediaKeepTheirIntensity) {
  for (double k : {1e-3, 1.0, 30.0})
    for (double pixels : {8.0, 1.0, 0.03}) {
      const Eye eye{{0, 0, 0}, {1, 0, 0}, 1.0, 16};
      const double range = 2.0 / (pixels * kPi / 180.0 / 16.0), x = 2.0 * k;
      const double mean = x < 0.01 ? x * (2.0 / 3.0 - x / 4.0) : 1.0 - 2.0 / (x * x) * (1.0 - (1.0 + x) * std::exp(-x));
      Cloud ball = of(placed(sphere(1), {range, 0.003 * range, 0.001 * range}), k, 500);
      for (double background : {0.0, 280.0}) {
        const std::string before = background > 0.0 ? "background: {temperature: 280 K}\n" : "";
        const std::string nothing = "entities:\n" + Wall{-500}.yaml("unseen", 1.0);
        const double got = irradiance(before + "entities:\n" + ball.yaml("c") + eye.yaml(kIrradiance)) - irradiance(before + nothing + eye.yaml(kIrradiance));
        figure("sphere of gas, k r " + text(k) + ", " + text(pixels) + " pixels, background " + text(background) + " K, contrast [W/m2]", got,
               kPi * mean * (B(500) - B(background)) / (range * range), 5e-3, "mean of 1 - exp(-k s) over the disc; silhouette; 1/R2 at its middle");
      }
    }
}

TEST(TransparentTraps, SmallPanesKeepTheirIntensity) {
  for (double pixels : {8.0, 1.0, 0.03}) {
    const Eye eye{{0, 0, 0}, {1, 0, 0}, 1.0, 16};
    const double range = 1.0 / (pixels * kPi / 180.0 / 16.0);
    const std::string pane =
        "entities:\n  - {name: w, shape: {model: plate, width: 1 m, height: 1 m}, material: {transmission: {transmittance: 0.3}}, temperature: 500 K, "
        "position: " +
        text(glm::dvec3(range, 0.003 * range, 0.001 * range)) + "}\n";
    for (double background : {0.0, 280.0}) {
      const std::string before = background > 0.0 ? "background: {temperature: 280 K}\n" : "";
      const double got =
          irradiance(before + pane + eye.yaml(kIrradiance)) - irradiance(before + "entities:\n" + Wall{-500}.yaml("unseen", 1.0) + eye.yaml(kIrradiance));
      figure("pane of " + text(pixels) + " pixels, background " + text(background) + " K, contrast [W/m2]", got,
             0.7 * (B(500) - B(background)) / (range * range), 3e-3, "(1 - T) (B - B_behind) A/R2; silhouette");
    }
  }
}

}  // namespace
}  // namespace pitviper::test
