// Where numbers get very large, very small or degenerate: finite, and right against a closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string camera(const std::string& position, const std::string& band = "[8 um, 12 um]", const std::string& more = "") {
  return "cameras: [{name: c, film: {width: 17, height: 17}, field_of_view: 2 deg, aperture: 20 mm, position: " + position + ", look_at: [0 m, 0 m, 0 m], " +
         more + "channels: [{name: a, response: {band: " + band + "}}]}]\n";
}

double middle(const Simulation& sim) {
  const Frame f = renderFrame(sim);
  for (float v : f.layers[0].pixels) EXPECT_TRUE(std::isfinite(v));
  return at(f.layers[0], f, 8, 8);
}

std::string plate(double kelvin, const std::string& material = "blackbody", const std::string& more = "") {
  return "entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: " + material + ", temperature: " + std::to_string(kelvin) + " K" +
         more + "}]\n";
}

TEST(Extremes, PlanckFromTwoToSixThousandKelvin) {
  for (const auto& [low, high] : {std::pair{0.3, 0.4}, {0.9, 1.1}, {3.0, 5.0}, {8.0, 12.0}, {28.0, 30.0}})
    for (double t : {2.0, 20.0, 77.0, 300.0, 1500.0, 6000.0}) {
      const double got = middle(scene(plate(t) + camera("[9 m, 0 m, 0 m]", "[" + std::to_string(low) + " um, " + std::to_string(high) + " um]"))),
                   want = blackBodyBand(low, high, t);
      if (want < 1e-37) {
        EXPECT_LE(got, 1.2e-37) << low << " um, " << t << " K: below what single precision holds";
      } else {
        figure("black plate " + std::to_string(static_cast<int>(t)) + " K, " + std::to_string(low).substr(0, 4) + " um", got, want, want < 1e-30 ? 1e-3 : 1e-5,
               "Planck series");
      }
    }
}

TEST(Extremes, AbsoluteZeroIsBlack) {
  EXPECT_EQ(middle(scene(plate(0) + camera("[9 m, 0 m, 0 m]"))), 0.0);
  EXPECT_EQ(middle(scene(camera("[9 m, 0 m, 0 m]"))), 0.0) << "nothing in view, no background given";
}

// Optical depth from 1e-9 to 1e6: the air's own radiance is L (1 - exp(-x)) without cancellation.
TEST(Extremes, OpticalDepthFromNothingToOpaque) {
  for (double x : {1e-9, 1e-6, 1e-3, 0.1, 1.0, 30.0, 1e3, 1e6}) {
    char extinction[64];
    std::snprintf(extinction, sizeof extinction, "%.12e /km", x / 9.0 * 1e3);
    const double got = middle(scene("atmosphere: {extinction: " + std::string(extinction) + ", temperature: 300 K}\n" + plate(0) + camera("[9 m, 0 m, 0 m]")));
    char name[64];
    std::snprintf(name, sizeof name, "air before a cold plate, optical depth %g", x);
    figure(name, got, -blackBodyBand(8, 12, 300) * std::expm1(-x), 1e-5, "L (1 - exp(-x)); single precision");
  }
}

TEST(Extremes, GrazingView) {
  for (double off : {89.9, 89.99, 89.999}) {
    const double a = off * kPi / 180.0;
    char position[96];
    std::snprintf(position, sizeof position, "[%.12f m, %.12f m, 0 m]", 5.0 * std::cos(a), 5.0 * std::sin(a));
    const auto sim = scene(
        "sun: {azimuth: 90 deg, elevation: 0 deg, irradiance: 10 W/(m2 um)}\n"
        "entities: [{name: p, shape: {model: plate, width: 90 km, height: 90 km}, material: {components: [{reflection: lambertian, reflectance: 0.5}]}, "
        "temperature: 300 K, heading: 90 deg}]\n" +
        camera(position));
    char name[64];
    std::snprintf(name, sizeof name, "lit plate seen at %.3f deg", off);
    figure(name, middle(sim), 0.5 * blackBodyBand(8, 12, 300) + 0.5 / kPi * 10.0 * 4.0, 1e-5, "same radiance at any angle");
  }
}

// A light nearer than its own radius shines as from that distance: I/r2; behind the surface it does not shine.
TEST(Extremes, LightsAtAndInsideASurface) {
  auto lit = [](const char* where) {
    return middle(scene("lights: [{name: l, intensity: 10 W/(sr um), visible: false, radius: 0.1 m, position: " + std::string(where) + "}]\n" +
                        plate(0, "white_lambertian") + camera("[9 m, 0 m, 0 m]")));
  };
  figure("light 0.1 mm before a white plate", lit("[0.0001 m, 0 m, 0 m]"), 10.0 * 4.0 / 0.01 / kPi, 1e-5, "I/(pi r2) at the bound r = 0.1 m");
  const double at = lit("[0 m, 0 m, 0 m]");  // in the very surface: no direction, but finite
  EXPECT_GE(at, 0.0);
  EXPECT_LE(at, 10.0 * 4.0 / 0.01 / kPi * 1.00001);
  EXPECT_EQ(lit("[-1 m, 0 m, 0 m]"), 0.0);
}

TEST(Extremes, EmissivityZeroAndOne) {
  EXPECT_EQ(middle(scene(plate(500, "{components: [{reflection: lambertian, reflectance: 1}]}") + camera("[9 m, 0 m, 0 m]"))), 0.0);
  figure("emissivity 1 by no components", middle(scene(plate(500, "{}") + camera("[9 m, 0 m, 0 m]"))), blackBodyBand(8, 12, 500), 1e-5, "Planck series");
}

TEST(Extremes, RadianceFromFaintToBlinding) {
  for (const char* radiance : {"1e-30 W/(m2 sr um)", "1e-9 W/(m2 sr um)", "1e9 W/(m2 sr um)"}) {
    const double got = middle(scene("background: {radiance: " + std::string(radiance) + "}\n" + camera("[9 m, 0 m, 0 m]")));
    figure("background of " + std::string(radiance), got, 4.0 * std::stod(radiance), 1e-6, "4 um of it");
  }
}

// Photon counts to 1e22 and beyond stay finite: flux is scaled in double precision.
TEST(Extremes, PhotonCounts) {
  const auto sim = scene(
      "background: {radiance: 1e9 W/(m2 sr um)}\ncameras: [{name: c, film: {width: 5, height: 5}, field_of_view: 2 deg, aperture: 1 m, exposure: 100 s, "
      "position: [0 m, 0 m, 0 m], heading: 0 deg,"
      " channels: [{name: a, response: {band: [3.9 um, 4.1 um]}, output: photons}]}]\n");
  const Frame f = renderFrame(sim);
  const double pixel = std::pow(2.0 * std::tan(kPi / 180.0) / 5.0, 2);
  figure("photons on the middle pixel", at(f.layers[0], f, 2, 2), 1e9 * 0.2 * 4e-6 / (6.62607015e-34 * 299792458.0) * pixel * 0.25 * kPi * 100.0, 1e-4,
         "the pixel's own size: cos4 over 0.4 deg");
}

// Poles and the date line: the same picture as at the equator.
TEST(Extremes, PolesAndDateLine) {
  double reference = 0.0;
  for (const char* origin : {"{latitude: 0 deg, longitude: 0 deg}", "{latitude: 90 deg, longitude: 0 deg}", "{latitude: -90 deg, longitude: 123 deg}",
                             "{latitude: 12 deg, longitude: 180 deg}", "{latitude: 12 deg, longitude: -180 deg}"}) {
    const auto sim = scene("origin: " + std::string(origin) + "\natmosphere: {extinction: 20 /km, temperature: 280 K, top: 3 km}\n" + plate(300) +
                           camera("[9 m, 0 m, 0 m]"));
    const double got = middle(sim);
    if (reference == 0.0) {
      reference = got;
      figure("plate through 9 m of thick air", got, blackBodyBand(8, 12, 300) * std::exp(-0.18) - blackBodyBand(8, 12, 280) * std::expm1(-0.18), 1e-5,
             "Beer-Lambert");
    }
    EXPECT_NEAR(got / reference, 1.0, 1e-6) << origin;
  }
}

// Geodetic positions a millimetre apart, 60 km from the origin, in front of a camera: the steps are seen.
TEST(Extremes, MillimetreStepsFarFromTheOrigin) {
  for (int mm : {0, 1, 2, 5}) {
    const double y = 60000.0 + mm * 1e-3;
    const auto sim = scene("entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: blackbody, temperature: 300 K, position: [0 m, " +
                           std::to_string(y) +
                           " m, 0 m], heading: 180 deg}]\n"
                           "cameras: [{name: c, film: {width: 17, height: 17}, field_of_view: 2 deg, aperture: 20 mm, position: [0 m, 59990 m, 0 m], heading: "
                           "0 deg, truth: [range], channels: [{name: a, response: {band: [8 um, 12 um]}}]}]\n");
    const Frame f = renderFrame(sim);
    figure("range with a step of " + std::to_string(mm) + " mm, 60 km from the origin [m]", at(layer(f, "truth.range"), f, 8, 8), 10.0 + mm * 1e-3, 1e-6,
           "camera-relative coordinates");
  }
}

}  // namespace
}  // namespace pitviper::test
