// A layer of air with a top over a spherical earth: chords worked out here by intersecting the line with the sphere.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kTop = 2000.0, kGamma = 0.5e-3;

/// Length of the segment a-b inside the sphere of the layer's top, by the quadratic in long double.
double chord(const LocalFrame& frame, glm::dvec3 a, glm::dvec3 b) {
  const long double radius = static_cast<long double>(frame.earthRadius_m()) + kTop;
  auto centred = [&](const glm::dvec3& p, int i) { return static_cast<long double>(p[i]) + (i == 2 ? static_cast<long double>(frame.earthRadius_m()) : 0.0L); };
  long double qa = 0, qb = 0, qc = -radius * radius;
  for (int i = 0; i < 3; ++i) {
    const long double d = static_cast<long double>(b[i]) - static_cast<long double>(a[i]);
    qa += d * d;
    qb += 2 * d * centred(a, i);
    qc += centred(a, i) * centred(a, i);
  }
  const long double disc = qb * qb - 4 * qa * qc;
  if (disc <= 0) return 0.0;
  const long double t0 = std::max(0.0L, (-qb - std::sqrt(disc)) / (2 * qa)), t1 = std::min(1.0L, (-qb + std::sqrt(disc)) / (2 * qa));
  return static_cast<double>(std::max(0.0L, t1 - t0) * std::sqrt(qa));
}

std::string place(const glm::dvec3& p) {
  char text[120];
  std::snprintf(text, sizeof text, "[%.6f m, %.6f m, %.6f m]", p.x, p.y, p.z);
  return text;
}

std::string label(const glm::dvec3& p) {
  char text[80];
  std::snprintf(text, sizeof text, "(%g, %g, %g) km", p.x / 1000.0, p.y / 1000.0, p.z / 1000.0);
  return text;
}

/// A level plate at the origin seen from `eye`, a black body of 300 K or lit by what `light` says.
double seen(const glm::dvec3& eye, const std::string& plate, const std::string& light) {
  const double size = glm::length(eye) * 0.2;
  const auto sim = scene(
      "atmosphere: {extinction: 0.5 /km, top: 2 km}\n" + light + "entities: [{name: p, shape: {model: plate, width: " + std::to_string(size) +
      " m, height: " + std::to_string(size) + " m}, " + plate +
      ", heading: 0 deg, pitch: 90 deg}]\ncameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.1 deg, aperture: 20 mm, position: " + place(eye) +
      ", look_at: [0 m, 0 m, 0 m], near: 1 m, channels: [{name: a, response: {band: [8 um, 12 um]}}]}]\n");
  const Frame f = renderFrame(sim);
  return at(f.layers[0], f, 4, 4);
}

const glm::dvec3 kEyes[] = {{0, 0, 1000},         {0, 0, 2001},        {0, 0, 10000},       {3000, 0, 1500},
                            {20000, 4000, 10000}, {100000, 0, 100000}, {500000, 0, 700000}, {0, 0, 2e7}};

TEST(LayeredAir, EmissionFromInsideAndAbove) {
  const LocalFrame frame;
  for (const auto& eye : kEyes)
    figure("plate through 2 km of air, camera at " + label(eye), seen(eye, "material: blackbody, temperature: 300 K", ""),
           blackBodyBand(8, 12, 300) * std::exp(-kGamma * chord(frame, eye, glm::dvec3(0.0))), eye.z > 1e6 ? 2e-3 : 3e-5,
           "chord with the sphere, exp(-gamma s); a range of 20000 km has 2 m of rounding");
}

TEST(LayeredAir, SunlitFromInsideAndAbove) {
  const LocalFrame frame;
  const double e = 30.0 * kPi / 180.0;
  const glm::dvec3 sun(0.0, -std::cos(e), std::sin(e));
  for (const auto& eye : kEyes) {
    const double legs = chord(frame, eye, glm::dvec3(0.0)) + chord(frame, glm::dvec3(0.0), sun * 1e8);
    figure("sunlit plate through 2 km of air, camera at " + label(eye),
           seen(eye, "material: {components: [{reflection: lambertian, reflectance: 0.5}]}, temperature: 0 K",
                "sun: {azimuth: 180 deg, elevation: 30 deg, irradiance: 100 W/(m2 um)}\n"),
           0.5 / kPi * 100.0 * 4.0 * std::sin(e) * std::exp(-kGamma * legs), eye.z > 1e6 ? 2e-3 : 1e-4,
           "both legs; a height of 0 found from 20000 km has 2 m of rounding");
  }
}

TEST(LayeredAir, LampAboveTheLayer) {
  const LocalFrame frame;
  for (const auto& eye : {glm::dvec3(3000, 0, 1500), glm::dvec3(100000, 0, 20000)}) {
    const glm::dvec3 lamp(2000, 1000, 6000);
    const double d2 = glm::dot(lamp, lamp), legs = chord(frame, eye, glm::dvec3(0.0)) + chord(frame, glm::dvec3(0.0), lamp);
    figure("lamp 6 km up on a plate, camera at " + label(eye),
           seen(eye, "material: {components: [{reflection: lambertian, reflectance: 0.5}]}, temperature: 0 K",
                "lights: [{name: l, intensity: 1e7 W/(sr um), visible: false, position: " + place(lamp) + "}]\n"),
           0.5 / kPi * 1e7 * 4.0 * lamp.z / std::pow(d2, 1.5) * std::exp(-kGamma * legs), 1e-4, "both legs");
  }
}

}  // namespace
}  // namespace pitviper::test
