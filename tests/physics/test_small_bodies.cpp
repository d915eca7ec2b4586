// A target keeps its intensity at any range: sum over pixels of (L - L_background) w = tau (I - L_background A)/R2.
// Error: the silhouette on a turned 256 x 256 view (0.1 %), and single precision.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "sim/camera/small_bodies.hpp"
#include "sim/camera/whole_pixel.hpp"
#include "sim/camera/zoomed_lines.hpp"
#include "sim/plan/planner.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/world/ray_hits.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

struct Contrast {
  double measured, expected;
};

/// A square of 2 m at `pixels` of a pixel (by side), over a background, in air, placed off the middle of a pixel.
Contrast squareOf(double pixels, double shift, int samples) {
  const double ifov = 2.0 * std::tan(kPi / 180.0) / 33.0, range = 2.0 / (pixels * ifov), g = 1.0 / range;
  const auto sim = scene("background: {temperature: 260 K}\natmosphere: {extinction: " + std::to_string(g * 1e3 * 1e6) +
                         "e-6 /km, temperature: 250 K}\n"
                         "entities: [{name: p, shape: {model: plate, width: 2 m, height: 2 m}, material: blackbody, temperature: 600 K, position: [0 m, " +
                         std::to_string(shift * ifov * range) + " m, " + std::to_string(0.61 * shift * ifov * range) +
                         " m]}]\n"
                         "cameras:\n  - {name: c, film: {width: 33, height: 33}, field_of_view: 2 deg, aperture: 20 mm, position: [" +
                         std::to_string(range) + " m, 0 m, 0 m], heading: 270 deg, samples: " + std::to_string(samples) +
                         ", channels: [{name: mw, response: {band: [3 um, 5 um]}}]}\n");
  const CameraImage image = renderImage(sim);
  // Behind the target the air goes on for ever: the background is the air's own radiance. The picture's own background pixel is taken
  // away, so that its rounding, summed over all pixels, does not pass for contrast.
  const double background = blackBodyBand(3, 5, 250);
  EXPECT_NEAR(image.slots[0][0] / background, 1.0, 1e-6);
  double total = 0.0;
  for (size_t p = 0; p < image.slots[0].size(); ++p) total += (image.slots[0][p] - image.slots[0][0]) * image.solidAngles->plain_sr[p];
  const double tau = std::exp(-1.0);
  return {total, tau * (blackBodyBand(3, 5, 600) - background) * 4.0 / range / range};
}

TEST(SmallBodies, UnresolvedSquareKeepsItsIntensity) {
  for (double area : {1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const Contrast c = squareOf(std::sqrt(area), 0.3, 1);
    char name[64];
    std::snprintf(name, sizeof name, "square of %g pixel, contrast intensity", area);
    figure(name, c.measured, c.expected, 5e-3, "tau (I - L_b A)/R2; silhouette on 256 x 256, background in single precision");
  }
}

// Moving through the pixel grid does not make it flicker.
TEST(SmallBodies, NoFlickerAcrossPixels) {
  double worst = 0.0;
  for (int i = 0; i < 12; ++i) {
    const Contrast c = squareOf(0.7 + 0.15 * i, 0.37 * i, 1);
    worst = std::max(worst, std::abs(c.measured / c.expected - 1.0));
  }
  bound("square of 0.7 to 2.4 pixels across the grid, worst error", worst, 5e-3, "silhouette on a turned 256 x 256 view");
}

// From 100 pixels in area down: no step.
TEST(SmallBodies, NoStepDownFromAHundredPixels) {
  double worst = 0.0;
  for (double pixels : {10.0, 7.0, 5.0, 4.0, 3.0, 2.2, 2.0, 1.5, 1.0}) {
    const Contrast c = squareOf(pixels, 0.37, 1);
    worst = std::max(worst, std::abs(c.measured / c.expected - 1.0));
  }
  bound("square of 10 x 10 to 1 pixels, worst error", worst, 5e-3, "silhouette on a turned 256 x 256 view");
}

// Beyond that a body is drawn as it falls on subpixels: an edge along the grid is off by up to half a subpixel on each side.
TEST(SmallBodies, ResolvedBodiesAreAsGoodAsTheirSubpixels) {
  double worst = 0.0;
  for (double pixels : {14.0, 18.0, 24.0}) {
    const Contrast c = squareOf(pixels, 0.37, 4);
    worst = std::max(worst, std::abs(c.measured / c.expected - 1.0));
  }
  bound("square of 14 to 24 pixels, 4x4 subpixels, worst error", worst, 2.0 / (4.0 * 14.0), "an edge falls on whole subpixels: 1/(4 x 14) per direction");
}

TEST(SmallBodies, HiddenBehindAnother) {
  const std::string head =
      "background: {temperature: 0 K}\nentities:\n  - {name: far, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 600 K, position: "
      "[-9000 m, 0 m, 0 m]}\n";
  const std::string wall =
      "  - {name: wall, shape: {model: plate, width: 900 m, height: 900 m}, material: blackbody, temperature: 0 K, position: [-5000 m, 0 m, 0 m]}\n";
  const std::string cam =
      "cameras:\n  - {name: c, film: {width: 33, height: 33}, field_of_view: 2 deg, aperture: 20 mm, position: [0 m, 0 m, 0 m], heading: 270 deg, channels: "
      "[{name: mw, response: {band: [3 um, 5 um]}}]}\n";
  EXPECT_GT(sum(layer(renderFrame(scene(head + cam)), "mw.radiance")), 0.0);
  EXPECT_EQ(sum(layer(renderFrame(scene(head + wall + cam)), "mw.radiance")), 0.0);
}

/// Radiance of the middle pixel: a warm wall begins 0.2 pixels left of its middle, which sees only the dark behind; before the part of it that the
/// wall fills lies a square of 0.16 pixels, of something transparent. 8 um to 12 um.
double overAnEdge(const std::string& square, const std::string& accuracy) {
  const double pixel_m = 2.0 * std::tan(kPi / 180.0) / 33.0 * 1000.0;
  char text[1024];
  std::snprintf(
      text, sizeof text,
      "background: {temperature: 0 K}\naccuracy: %s\nmaterials: {filter: {transmission: {transmittance: 0}}}\nentities:\n"
      "  - {name: wall, shape: {model: plate, width: 100 m, height: 100 m}, material: blackbody, temperature: 300 K, position: [%.9g m, 1010 m, 0 m]}\n"
      "  - {name: square, shape: {model: plate, width: %.9g m, height: %.9g m}, material: filter, temperature: %s, position: [%.9g m, 1000 m, 0 m]}\n"
      "cameras:\n  - {name: c, film: {width: 33, height: 33}, field_of_view: 2 deg, aperture: 20 mm, position: [0 m, 0 m, 0 m], heading: 0 deg,\n"
      "     channels: [{name: lw, response: {band: [8 um, 12 um]}}]}\n",
      accuracy.c_str(), -50.0 - 0.2 * 1.01 * pixel_m, 0.16 * pixel_m, 0.16 * pixel_m, square.c_str(), -0.35 * pixel_m);
  std::string yaml(text);
  for (const char* name : {"1010 m, 0 m]", "1000 m, 0 m]"}) yaml.insert(yaml.find(name) + std::string(name).size(), ", heading: 180 deg");
  const CameraImage image = renderImage(scene(yaml));
  for (double l : image.slots[0]) EXPECT_GE(l, 0.0);
  return image.slots[0][16 * 33 + 16];
}

// What a body hides is no more than what the pixel has: its middle alone was looked at for the rest of the scene.
TEST(SmallBodies, HideNoMoreThanThereIs) {
  for (const std::string accuracy : {"1 %", "reference"}) {
    EXPECT_EQ(overAnEdge("0 K", accuracy), 0.0);
    figure("square of 0.16 pixels at 600 K over an edge, " + accuracy, overAnEdge("600 K", accuracy), 0.16 * 0.16 * blackBodyBand(8, 12, 600), 1e-2,
           "0.16^2 B; silhouette on 256 x 256, a pixel's tangent for its solid angle");
  }
}

/// What a warm glossy sphere of 3.4 pixels throws at the camera, with the sun and with one as good as dark [W/sr].
double glossySphere(const std::string& accuracy, double azimuth_deg, double sun) {
  char text[1500];
  std::snprintf(
      text, sizeof text,
      "background: {temperature: 0 K}\naccuracy: %s\nmaterials: {gloss: {components: [{reflection: phong, exponent: 4000, reflectance: 0.5}]}}\n"
      "sun: {azimuth: %g deg, elevation: 25 deg, irradiance: {wavelength: um, unit: W/(m2 um), values: [[3, %g], [4, %g]]}}\n"
      "entities:\n  - {name: s, shape: {model: sphere, radius: 2 m, segments: 256}, material: gloss, temperature: 400 K, position: [0.3 m, 1000 m, 0.4 m]}\n"
      "cameras:\n  - {name: c, film: {width: 9, height: 9}, field_of_view: 0.6 deg, aperture: 20 mm, position: [0 m, 0 m, 0 m], heading: 0 deg,\n"
      "     channels: [{name: v, response: {band: [3.6 um, 3.8 um]}}]}\n",
      accuracy.c_str(), azimuth_deg, sun, sun);
  const CameraImage image = renderImage(scene(text));
  double intensity = 0.0;
  for (size_t p = 0; p < image.slots[0].size(); ++p) intensity += image.slots[0][p] * image.solidAngles->plain_sr[p] * 1e6;
  return intensity;
}

// A glossy sphere throws the sun's light evenly all around, from a spot of half a degree wherever it happens to lie: E a^2 / 4 times the lobe's
// reflectance; a lobe without 1 / cos(theta) has the cosine of incidence besides. (The reference once took what lies between warm
// places for no more than warm, and a plan dropped a sun that no line of its own had seen.)
TEST(SmallBodies, GlintIsNotMissed) {
  for (const auto& [accuracy, azimuth] : {std::pair<std::string, double>{"1 %", 73.0}, {"1 %", 131.0}, {"1 %", 222.0}, {"reference", 222.0}}) {
    // The viewer is south of the sphere: half of the angle between what goes to the sun and what goes to the viewer.
    const double between = std::acos(-std::cos(azimuth * kPi / 180.0) * std::cos(25.0 * kPi / 180.0));
    figure("glossy sphere of 3.4 pixels, sun at " + std::to_string(static_cast<int>(azimuth)) + " deg, " + accuracy + ", intensity [W/sr]",
           glossySphere(accuracy, azimuth, 100.0) - glossySphere(accuracy, azimuth, 1e-6), 0.5 * 20.0 * 2.0 * 2.0 / 4.0 * std::cos(0.5 * between), 0.015,
           "1/n of the lobe's width; 256 facets around; zoomed view");
  }
}

/// Spheres of 0.1 to 0.4 m a kilometre away, some before others.
std::string spheres(int count) {
  std::string all = "entities:\n";
  for (int i = 0; i < count; ++i)
    all += "- {name: s" + std::to_string(i) + ", shape: {model: sphere, radius: " + std::to_string(0.1 + 0.3 * i / count) +
           " m}, material: " + (i % 3 == 0 ? "glossy" : "plain") + ", temperature: " + std::to_string(300 + 10 * i) + " K, position: [" +
           std::to_string(0.5 * i) + " m, " + std::to_string(std::fmod(3.7 * i, 11.0) - 5.0) + " m, " + std::to_string(std::fmod(5.3 * i, 9.0) - 4.0) +
           " m]}\n";
  return all;
}

// Direct mode draws bodies as tiles of one picture, buffered mode one by one.
TEST(SmallBodies, AsTilesAsOneByOne) {
  const std::string rest =
      "sun: {azimuth: 60 deg, elevation: 30 deg, temperature: 5772 K}\natmosphere: {extinction: 0.1 /km, temperature: 280 K}\nmaterials: {plain: {components: "
      "[{reflection: "
      "lambertian, reflectance: 0.2}]}, glossy: {components: [{reflection: phong, reflectance: 0.3, exponent: 9}]}}\n" +
      spheres(37) +
      "cameras: [{name: c, film: {width: 48, height: 48}, field_of_view: 1 deg, aperture: 20 mm, position: [1000 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], "
      "truth: [range, entity], "
      "spectral: {samples: 4}, channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n";
  const Frame tiles = renderFrame(scene("render: {mode: direct}\n" + rest)), alone = renderFrame(scene("render: {mode: buffered}\n" + rest));
  EXPECT_EQ(layer(tiles, "truth.entity").pixels, layer(alone, "truth.entity").pixels);
  double worst = 0.0;
  for (size_t p = 0; p < tiles.layers[0].pixels.size(); ++p) {
    const auto a = static_cast<double>(layer(tiles, "mw.radiance").pixels[p]), b = static_cast<double>(layer(alone, "mw.radiance").pixels[p]);
    worst = std::max(worst, std::abs(a / b - 1.0));
  }
  bound("37 small bodies as tiles against one by one, worst pixel", worst, 2e-6, "single precision in another order");
}

// Where an accuracy is asked for, lines across a body are as many as its area takes.
TEST(SmallBodies, LinesFollowTheAccuracy) {
  const auto sphere = [](double accuracy) {
    return scene(
        (accuracy > 0.0 ? "accuracy: " + std::to_string(100.0 * accuracy) + " %\n" : "") +
        "entities: [{name: s, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 600 K}]\ncameras: [{name: c, film: {width: 33, height: "
        "33}, field_of_view: 2 deg, aperture: 20 mm, position: [2000 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], channels: [{name: mw, response: {band: [3 um, 5 "
        "um]}}]}]\n");
  };
  const Simulation any = sphere(0.0);
  int last = 16;
  for (double accuracy : {0.1, 0.03, 0.01, 0.003, 0.001}) {
    const int lines = zoomedLines(any, 4096, accuracy)[0];
    EXPECT_GE(lines, last);
    last = lines;
    const CameraImage image = renderImage(sphere(accuracy));
    double total = 0.0;
    for (size_t p = 0; p < image.slots[0].size(); ++p) total += image.slots[0][p] * image.solidAngles->plain_sr[p];
    // A quarter of it is 1 sigma; the mesh of 64 segments lacks 0.1 % of the circle's area (its outline's corners lie on it).
    figure("flux of a sphere of a pixel asked for to " + std::to_string(100.0 * accuracy) + " %", total, blackBodyBand(3, 5, 600) * kPi / 4e6,
           0.4 * accuracy + 2e-3, "pi r^2 / R^2; outline of the mesh 0.1 %, better than 2 sigma of the lines");
  }
  EXPECT_EQ(last, 192);  // 0.61 / lines^1.5 < 0.001 / 4
  EXPECT_EQ(zoomedLines(any, 256, 0.0)[0], 256);
}

// The law that chooses lines: over directions, areas are off by no more than sqrt(0.0724 P h^3) / A. A box shows its three visible faces, and each edge twice
// in its outline.
TEST(SmallBodies, AreaIsAsGoodAsItsLines) {
  const glm::dvec3 size(2.0, 1.4, 0.8);
  constexpr double kRange_m = 20000.0;
  for (int lines : {16, 32, 64}) {
    double squares = 0.0;
    constexpr int kDirections = 40;
    for (int n = 0; n < kDirections; ++n) {
      // Evenly over the sphere, by the golden angle.
      const double z = 1.0 - (2.0 * n + 1.0) / kDirections, turn = 2.399963229728653 * n, r = std::sqrt(1.0 - z * z);
      const glm::dvec3 to(r * std::cos(turn), r * std::sin(turn), z);
      const glm::dvec3 at = kRange_m * to;
      Simulation sim = scene(
          "background: {temperature: 0 K}\nentities: [{name: b, shape: {model: box, length: 2 m, width: 1.4 m, height: 0.8 m}, material: blackbody, "
          "temperature: "
          "600 K, heading: 0 deg, position: [0 m, 0 m, 0 m]}]\ncameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.06 deg, aperture: 20 mm, "
          "position: [" +
          print("%.9g", at.x) + " m, " + print("%.9g", at.y) + " m, " + print("%.9g", at.z) +
          " m], look_at: [0 m, 0 m, 0 m], channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n");
      sim.cameras[0].zoomedSamples = lines;
      const CameraImage image = renderImage(sim);
      double total = 0.0;
      for (size_t p = 0; p < image.slots[0].size(); ++p) total += image.slots[0][p] * image.solidAngles->plain_sr[p];
      // Heading 0 points the body's length north, along y.
      const glm::dvec3 axes(size.y, size.x, size.z), n2 = glm::abs(to);
      const double area = axes.y * axes.z * n2.x + axes.z * axes.x * n2.y + axes.x * axes.y * n2.z;
      double outline = 0.0;
      for (int k = 0; k < 3; ++k) outline += 2.0 * axes[k] * std::sqrt(1.0 - n2[k] * n2[k]);
      const double spacing = glm::length(size) * 1.02 / lines;
      const double error = total / (blackBodyBand(3, 5, 600) * area / kRange_m / kRange_m) - 1.0;
      squares += std::pow(error * area / std::sqrt(0.0724 * outline * std::pow(spacing, 3.0)), 2.0);
    }
    bound("areas of a box from 40 directions on " + std::to_string(lines) + " lines, mean square by the law", squares / kDirections, 1.0,
          "sqrt(0.0724 P h^3) / A; no line of the grid lies on the middle of what is even");
  }
}

// Bodies that share a pixel, before and behind each other, some of gas, some far finer than others: each line counts once.
TEST(SmallBodies, ManyInAPixelAgainstRaysAllOverIt) {
  std::mt19937 dice(41);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  constexpr std::uint64_t kSeeds = 6;
  double worst = 0.0, sum = 0.0;
  int pixels = 0;
  for (int k = 0; k < 6; ++k) {
    std::string text = "background: {temperature: 260 K}\naccuracy: 1 %\nmaterials: {gas: {absorption: 0.4 /m}}\nentities:\n";
    for (int b = 0; b < 3 + k % 3; ++b) {
      const bool gas = (b + k) % 3 == 0;
      text += "- {name: b" + std::to_string(b) + ", shape: {model: sphere, radius: " + print("%.3f", (b % 2 ? 0.35 : 1.1) * (0.6 + unit(dice))) +
              " m, segments: 128}, material: " + (gas ? "gas" : "blackbody") + print(", temperature: %.0f K, position: [", 300.0 + 500.0 * unit(dice)) +
              print("%.3f m, ", 3.0 * unit(dice) - 1.5) + print("%.3f m, ", 1000.0 + 8.0 * b) + print("%.3f m]}\n", 3.0 * unit(dice) - 1.5);
    }
    text +=
        "cameras:\n- {name: c, film: {width: 7, height: 7}, field_of_view: 1.2 deg, aperture: 20 mm, position: [0 m, 0 m, 0 m], heading: 0 deg,\n"
        "   channels: [{name: mw, response: {band: [4 um, 5 um]}}]}\n";
    Simulation sim = scene(text);
    const WorldState state = advance(sim, 0.0);
    const CameraImage image = renderImage(sim);
    const Plan plan = planFor(sim, {&sim.cameras[0], nullptr});
    for (int p = 0; p < 49; ++p) {
      const double drawn = image.slots[0][static_cast<size_t>(p)];
      if (drawn < 1.02 * blackBodyBand(4, 5, 260)) continue;
      double mean = 0.0, variance = 0.0;
      for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const auto seen = WholePixels(sim, sim.cameras[0], plan, seed).look(state, p);
        ASSERT_TRUE(seen);
        mean += seen->mean[0] / kSeeds;
        variance += seen->error[0] * seen->error[0] / (kSeeds * kSeeds);
      }
      ++pixels;
      worst = std::max(worst, (std::abs(drawn - mean) - 0.01 * mean) / std::sqrt(variance));
      sum += drawn / mean - 1.0;
    }
  }
  EXPECT_GT(pixels, 20);
  bound("pixels with three to five small bodies against 6 x 32 x 32 rays each, worst beyond 1 %, in standard errors of the rays", worst, 3.0, "1 % asked");
  bound("the same, mean of all", std::abs(sum) / pixels, 0.015, "standard errors of 1 to 10 % each, of some 30 pixels");
}

// How many of a zoomed view's lines see its body is what its shadows are priced by: exact for an ellipsoid, about right for others.
TEST(SmallBodies, LinesThatSeeABodyAreForeseen) {
  const auto foreseen = [](const std::string& shape, const glm::dvec3& from, double& found) {
    const Simulation sim = scene("entities: [{name: b, shape: " + shape +
                                 ", material: blackbody, temperature: 300 K, position: [0 m, 0 m, 0 m]}]\ncameras: [{name: c, film: {width: 9, height: 9}, "
                                 "field_of_view: 1 deg, aperture: 20 mm, position: [" +
                                 print("%.9g m, ", from.x) + print("%.9g m, ", from.y) + print("%.9g m]", from.z) +
                                 ", look_at: [0 m, 0 m, 0 m], channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n");
    const WorldState state = advance(sim, 0.0);
    const Ball ball = ballOf(sim, state, 0);
    constexpr int kLines = 200;
    const View z = zoomedView(ball, cameraView(sim.cameras[0], state, 1), kLines);
    int met = 0;
    for (int y = 0; y < kLines; ++y)
      for (int x = 0; x < kLines; ++x) {
        const glm::dvec3 ray = z.ray(x + 0.5, y + 0.5);
        met += meetsBody(sim, state, z.position, z.localFromCamera * ray / glm::length(ray), 0.1, 0);
      }
    found = static_cast<double>(met) / (kLines * kLines);
    const glm::dvec3 direction = glm::normalize(glm::conjugate(state.entities[0].orientation) * (ball.centre - z.position));
    return zoomedFill(glm::length(direction * facingAreas(sim)[0]), ball.radius_m);
  };
  double least = INFINITY, most = 0.0, found = 0.0;
  for (const glm::dvec3& from : {glm::dvec3(2000, 0, 0), glm::dvec3(0, -2000, 0), glm::dvec3(-1200, 900, 1300), glm::dvec3(700, -1800, -300)}) {
    const double told = foreseen("{model: ellipsoid, length: 6 m, width: 2 m, height: 1 m}", from, found);
    figure("part of a zoomed view that an ellipsoid fills", told, found, 0.02, "|(d_x A_x, d_y A_y, d_z A_z)|; facets, and 200 x 200 lines");
    for (const char* shape :
         {"{model: jet}", "{model: missile}", "{model: box, length: 4 m, width: 2 m, height: 1 m}", "{model: cylinder, radius: 0.5 m, length: 5 m}"}) {
      const double other = foreseen(shape, from, found);
      least = std::min(least, other / found), most = std::max(most, other / found);
    }
  }
  bound("the same of jets, missiles, boxes and cylinders, most over found", most, 3.5, "what lies behind more of a body is counted too");
  bound("found over the least of them", 1.0 / least, 1.75, "a box shows three faces: root 3");
}

}  // namespace
}  // namespace pitviper::test
