// What is said of light scattered more than once: the two-stream solution against closed forms, and the factor against daylight and published skies.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <tuple>

#include "sim/model/two_stream.hpp"
#include "sim/plan/planner.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

TEST(TwoStream, ScatteringWithoutLossIsEddingtons) {
  // Of a layer that only scatters, over black ground, with the sun at cos 2/3: 1 / (1 + 3/4 (1 - g) t) comes through, the rest goes back up.
  double through = 0.0, lost = 0.0, any = 0.0;
  for (double t : {0.01, 0.3, 1.0, 7.0, 100.0})
    for (double g : {0.0, 0.4, 0.66, 0.85}) {
      const TwoStream layer(t, 1.0, g, 2.0 / 3.0, 0.0);
      through = std::max(through, std::abs(layer.onLevel(t) * 1.5 * (1.0 + 0.75 * (1.0 - g) * t) - 1.0));
      lost = std::max(lost, std::abs(layer.onLevel(t) + layer.at(0.0).up - 2.0 / 3.0));
      // Any sun: ((2 + 3 m) + (2 - 3 m) exp(-t'/m)) / (4 + 3 (1 - g) t), t' = (1 - g^2) t (Joseph, Wiscombe and Weinman 1976).
      for (double m : {0.1, 0.4, 1.0}) {
        const double expected = ((2 + 3 * m) + (2 - 3 * m) * std::exp(-(1 - g * g) * t / m)) / (4 + 3 * (1 - g) * t);
        any = std::max(any, std::abs(TwoStream(t, 1.0, g, m, 0.0).onLevel(t) / m / expected - 1.0));
      }
    }
  bound("two streams without loss, sun at cos 2/3, transmission against 1 / (1 + 3/4 (1 - g) t), relative", through, 2e-5, "1e-9 of loss, depth 100");
  bound("the same, what goes down and up, less what came in", lost, 2e-5, "the same");
  bound("the same for other suns against the conservative solution, relative", any, 1e-4, "the same");
}

TEST(TwoStream, ThinAndBlackLimits) {
  // What absorbs alone leaves the beam; a thin layer scatters what it takes: down and up together w t.
  EXPECT_NEAR(TwoStream(2.0, 0.0, 0.5, 0.5, 0.3).at(2.0).beam, std::exp(-4.0), 1e-12);
  EXPECT_EQ(TwoStream(2.0, 0.0, 0.5, 0.5, 0.0).at(1.0).down, 0.0);
  for (double m : {0.3, 0.9}) {
    const TwoStream thin(1e-4, 0.8, 0.0, m, 0.0);
    EXPECT_NEAR((thin.at(1e-4).down + thin.at(0.0).up) / (0.8 * 1e-4), 1.0, 1e-3);
  }
  // White ground under a white layer gives everything back.
  EXPECT_NEAR(TwoStream(3.0, 1.0, 0.6, 0.7, 1.0).at(0.0).up, 0.7, 1e-4);
  // By halves as by the whole, and never below 0.
  for (double t : {0.0, 0.5, 5.0}) {
    const auto f = TwoStream(5.0, 0.9, 0.7, 0.1, 0.2).at(t);
    EXPECT_GE(f.down, 0.0);
    EXPECT_GE(f.up, 0.0);
    EXPECT_LE(f.beam, 1.0);
  }
}

/// Light on the ground under a layer by photons: Henyey and Greenstein's directions drawn from equal steps of their integral.
double onGroundByPhotons(double depth, double albedo, double g, double sinSun, int photons) {
  std::uint64_t seed = 12345;
  const auto dice = [&seed] {
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (static_cast<double>(seed >> 11) + 0.5) * 0x1p-53;
  };
  double landed = 0.0;
  for (int n = 0; n < photons; ++n) {
    double t = 0.0, weight = 1.0;
    glm::dvec3 d(std::sqrt(1.0 - sinSun * sinSun), 0.0, sinSun);  // z down
    while (weight > 1e-4) {
      t -= std::log(dice()) * d.z;
      if (t >= depth) landed += weight;
      if (t >= depth || t <= 0.0) break;
      weight *= albedo;
      const double u = 2.0 * dice() - 1.0, s = (1.0 - g * g) / (1.0 + g * u), c = (1.0 + g * g - s * s) / (2.0 * g),
                   across = std::sqrt(std::max(1.0 - c * c, 0.0)), phi = 2.0 * kPi * dice();
      const glm::dvec3 x = glm::normalize(glm::cross(std::abs(d.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0), d)), y = glm::cross(d, x);
      d = glm::normalize(c * d + across * (std::cos(phi) * x + std::sin(phi) * y));
    }
  }
  return sinSun * landed / photons;
}

TEST(TwoStream, IsWhatPhotonsDo) {
  double worst = 0.0;
  for (const auto& [depth, albedo, sun] : {std::tuple{0.5, 0.95, 0.64}, {2.0, 0.95, 0.64}, {6.0, 0.94, 0.64}, {6.0, 1.0, 0.64}, {1.0, 0.9, 0.3}})
    worst = std::max(worst, std::abs(TwoStream(depth, albedo, 0.66, sun, 0.0).onLevel(depth) / onGroundByPhotons(depth, albedo, 0.66, sun, 40000) - 1.0));
  bound("light on the ground under layers of depth 0.5 to 6, two streams against 40000 photons, relative", worst, 0.1, "two streams; photons 1 %");
}

double again(const Frame& frame, const std::string& channel) {
  for (const auto& a : frame.attributes)
    if (a.name == "pitviper.scattered_again." + channel) return std::get<double>(a.value);
  return 1.0;
}

std::string fogScene(double visibility_km) {
  return "atmosphere: {library: hazy_us76, visibility: " + print("%g", visibility_km) +
         " km}\nsun: {azimuth: 90 deg, elevation: 40 deg, irradiance: solar_e490}\nambient: {from: sky}\nentities:\n"
         "  - {name: white, shape: {model: plate, width: 3 m, height: 3 m}, material: white_lambertian, temperature: 288 K, position: [0 m, 0 m, 10 m], "
         "heading: 90 deg}\n"
         "  - {name: ground, shape: {model: plate, width: 30 km, height: 30 km}, heading: 180 deg, pitch: 90 deg, material: green_grass, temperature: 288 K}\n"
         "cameras: [{name: w, film: {width: 9, height: 9}, field_of_view: 1 deg, aperture: 50 mm, position: [100 m, 0 m, 10 m], look_at: white,\n"
         "  channels: [{name: vis, response: {band: [0.5 um, 0.6 um]}}, {name: lw, response: {band: [8 um, 12 um]}}]}]\n";
}

TEST(ScatteredAgain, FogIsDaylightAfterAll) {
  // A white plate 100 m off in the sun. Haze of 5 km takes little from daylight, what it scatters comes from elsewhere; haze of 1 km, six optical
  // depths of albedo 0.94, swallows most (two streams: a fifth comes through), where the picture has a thousandth.
  double daylight = 0.0, most = 1.0, least = 1.0, fog = 0.0, before = 1.0;
  for (double v : {50.0, 23.0, 5.0, 2.0, 1.0}) {
    const Frame frame = renderFrame(scene(fogScene(v)));
    const double once = at(frame.layers[0], frame, 4, 4), factor = again(frame, "vis");
    std::printf("visibility %g km: %.3g W/(m2 sr), times %.3g = %.3g\n", v, once, factor, once * factor);
    if (v == 50.0) daylight = once;
    if (v >= 5.0) most = std::max(most, once * factor / daylight), least = std::min(least, once * factor / daylight);
    else fog = std::max(fog, daylight / (once * factor));
    EXPECT_GE(factor, before * 0.99) << v;
    before = factor;
    EXPECT_EQ(again(frame, "lw"), 1.0);  // the sun does not light it
  }
  bound("white plate in haze of 5 to 50 km, with the factor stated, over daylight", most, 2.0, "two-stream estimate");
  bound("daylight over the same", 1.0 / least, 2.0, "two-stream estimate");
  bound("daylight over the same, haze of 1 and 2 km", fog, 12.0,
        "its own absorption, 6 optical depths of albedo 0.94; a wall faces half of what is left, and hardly any from the grass");
  EXPECT_GT(before, 100.0);
}

TEST(ScatteredAgain, HazySkies) {
  // Horizon of a hazy sky away from the sun at 0.55 um: 100 W/(m2 sr um), published skies; scattered once 15.
  const auto sky = [](const char* air, double pitch) {
    return renderFrame(
        scene(std::string("atmosphere: ") + air +
              "\nsun: {azimuth: 210 deg, elevation: 40 deg, temperature: 5772 K}\ncameras: [{name: e, film: {width: 3, height: 3}, field_of_view: 0.2 deg, "
              "aperture: 5 "
              "mm, position: [0 m, 0 m, 10 m], heading: 30 deg, pitch: " +
              print("%g", pitch) +
              " deg, channels: [{name: g, response: {band: [0.545 um, 0.555 um]}, output: radiance_per_um}, {name: lw, response: {band: [8 um, 12 um]}}]}]\n"));
  };
  for (double pitch : {0.3, 10.0, 30.0, 89.9}) {
    const Frame frame = sky("hazy_us76", pitch);
    const double once = at(frame.layers[0], frame, 1, 1), factor = again(frame, "g");
    std::printf("hazy sky at %g deg: %.3g, times %.3g = %.3g W/(m2 sr um)\n", pitch, once, factor, once * factor);
    if (pitch == 0.3) {
      EXPECT_GT(once * factor, 50.0);
      EXPECT_LT(once * factor, 200.0);
    }
    EXPECT_EQ(again(frame, "lw"), 1.0);
  }
  // Short ways in clear air by the near infrared: nothing to say.
  const Frame clear = renderFrame(
      scene("atmosphere: clear_us76\nsun: {azimuth: 90 deg, elevation: 60 deg, temperature: 5772 K}\nentities: [{name: p, shape: {model: plate, width: 3 m, "
            "height: 3 m}, material: white_lambertian, temperature: 288 K, heading: 90 deg, position: [0 m, 0 m, 10 m]}]\ncameras: [{name: c, film: {width: 3, "
            "height: 3}, field_of_view: 1 deg, aperture: 5 mm, position: [50 m, 0 m, 10 m], look_at: p, channels: [{name: n, response: {band: [1.5 um, 1.7 "
            "um]}}]}]\n"));
  EXPECT_EQ(again(clear, "n"), 1.0);
}

}  // namespace
}  // namespace pitviper::test
