// Refraction of a scenario: apparent elevations, sunset, the horizon and far things.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>

#include "atmosphere/bent_path.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/scene/geodesy.hpp"
#include "sim/sky/refraction.hpp"
#include "sim/sky/sky_places.hpp"
#include "sim/world/sun_legs.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0, kMinute = kDegree / 60.0;

/// By apparent elevation, at 1010 hPa and 10 C: cot(e + 7.31 / (e + 4.4)) arc minutes. Bennett 1982, J. Navigation 35, 255.
double bennett(double apparent_deg) { return 1.0 / std::tan((apparent_deg + 7.31 / (apparent_deg + 4.4)) * kDegree); }

TEST(Refraction, FormulaOfTrueElevationsIsBennetts) {
  double worst = 0.0;
  for (double e = 0.0; e <= 90.0; e += 0.5) {
    const double lift = std::max(bennett(e), 0.0);
    worst = std::max(worst, std::abs(refraction_rad(e * kDegree - lift * kMinute, 101000.0, 283.0) / kMinute - lift));
  }
  bound("refraction by true elevation against Bennett, 0 to 90 degrees [arc minutes]", worst, 0.15, "0.1 arc minutes, Meeus chapter 16");
  EXPECT_EQ(refraction_rad(-10.0 * kDegree, 101000.0, 283.0), refraction_rad(-1.0 * kDegree, 101000.0, 283.0));
}

TEST(Refraction, OfTheStandardAtmosphereIsBennetts) {
  const AbsorberTable air = AbsorberTable::read(std::filesystem::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/us76_rural.air");
  const auto bending = [&](double apparent_deg) {
    return bendingFromSpace(air, airRefractivity(0.574), 0.0, std::sin(apparent_deg * kDegree), 6371000.0) / kMinute;
  };
  double worst = 0.0;
  for (double e : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 45.0, 80.0, 90.0}) worst = std::max(worst, std::abs(bending(e) - 0.985 * std::max(bennett(e), 0.0)));
  bound("refraction of the standard atmosphere against Bennett, 0.5 to 90 degrees [arc minutes]", worst, 0.8, "on low lines the profile: 15 C, 6.5 K/km");
  bound("refraction on the horizon off 34 arc minutes", std::abs(bending(0.0) - 34.0), 2.0, "almanacs' 34 arc minutes");
  EXPECT_EQ(bending(-5.0), bending(0.0));
}

TEST(Refraction, HorizonAndDip) {
  const LocalFrame straight({50.0 * kDegree, 8.0 * kDegree, 0.0}), day({50.0 * kDegree, 8.0 * kDegree, 0.0}, 0.0, 0.13),
      standard({50.0 * kDegree, 8.0 * kDegree, 0.0}, 0.0, 0.163);
  EXPECT_NEAR(day.refraction(), 0.13, 1e-12);
  EXPECT_EQ(straight.refraction(), 0.0);
  const auto horizon_km = [](const LocalFrame& f, double h) {
    const double r = f.earthRadius_m();
    return 1e-3 * physics::groundRange(h, -std::sqrt(h * (2.0 * r + h)) / (r + h) - 1e-12, r);
  };
  for (double h : {2.0, 20.0, 200.0}) {
    figure(print("distance of the horizon without refraction, height %g m [km]", h), horizon_km(straight, h), 3.570 * std::sqrt(h), 2e-3, "sqrt(2 R h)");
    figure(print("with k = 0.13, height %g m [km]", h), horizon_km(day, h), 3.827 * std::sqrt(h), 2e-3, "sqrt(2 R h / (1 - k))");
    figure(print("with k = 0.163, height %g m [km]", h), horizon_km(standard, h), 1.852 * 2.119 * std::sqrt(h), 0.01,
           "Bowditch: 1.17 nautical miles a root of a foot");
    const double r = standard.earthRadius_m();
    figure(print("dip with k = 0.163, height %g m [arc minutes]", h), std::acos(r / (r + h)) / kMinute, 1.76 * std::sqrt(h), 0.005,
           "The Nautical Almanac: 1.76 arc minutes a root of a metre");
  }
}

TEST(Refraction, FarThingsStandHigher) {
  const Geodetic origin{50.0 * kDegree, 8.0 * kDegree, 0.0};
  constexpr double k = 0.13;
  const LocalFrame straight(origin), bent(origin, 0.0, k);
  for (double d_deg : {0.1, 0.3, 0.6}) {
    const Geodetic ship{50.0 * kDegree, (8.0 + d_deg) * kDegree, 0.0};
    const glm::dvec3 at = bent.toLocal(ship), before = straight.toLocal(ship);
    const double d = std::hypot(at.x, at.y);
    EXPECT_EQ(at.x, before.x);
    figure(print("elevation shift at %.0f km [arc minutes]", 1e-3 * d), (at.z - before.z) / d / kMinute, k * d / (2.0 * 6381000.0) / kMinute, 1e-3,
           "k d / (2 R)");
    // On the sea of the picture as on that of the earth: the sphere's own departure from the ellipsoid is the same.
    EXPECT_NEAR(bent.height(at), straight.height(before), 0.02 + 2e-9 * d * d / 10.0);
    EXPECT_LT(glm::length(bent.toLocal(bent.toGeodetic(at)) - at), 1e-6);
    EXPECT_LT(glm::length(bent.fromEcef(bent.toEcef(at)) - at), 1e-6);
    EXPECT_NEAR(bent.toGeodetic(at).height_m, 0.0, 1e-6);
  }
}

std::string horizonScene(const std::string& more) {
  return more +
         "\norigin: {latitude: 50 deg, longitude: 8 deg, height: 0 m}\nsun: {temperature: 5772 K}\n"
         "entities: [{name: ship, shape: {model: sphere, radius: 10 m}, material: {components: [{reflection: lambertian, reflectance: 0}]}, temperature: 290 "
         "K, "
         "geodetic: {latitude: 50.3 deg, longitude: 8 deg, height: 0 m}}]\n"
         "cameras: [{name: c, film: {width: 2, height: 2}, field_of_view: 5 deg, aperture: 5 mm, position: [0 m, 0 m, 1 m], heading: 0 deg, "
         "channels: [{name: a, response: {band: [0.5 um, 0.6 um]}}]}]\n";
}

std::string dateOf(int second) { return print("date: 2026-06-21T%02d:%02d:%02dZ", 19 + second / 3600, second / 60 % 60, second % 60); }

double trueElevation(int second) {
  std::string problem;
  return sunPlace(*parseInstant(dateOf(second).substr(6), problem), {50.0 * kDegree, 8.0 * kDegree, 0.0}).elevation_rad;
}

/// The second of that evening at which the sun's centre sinks through a true elevation.
int secondOf(double elevation_rad) {
  int low = 0, high = 4 * 3600;
  while (high - low > 1) (trueElevation((low + high) / 2) > elevation_rad ? low : high) = (low + high) / 2;
  return high;
}

TEST(Refraction, TheSunSetsWhenItIsFiftyMinutesDown) {
  for (const char* air : {"atmosphere: none", "atmosphere: hazy_us76"}) {
    const auto shareAt = [&](double minutes, const char* refraction) {
      const Simulation sim =
          scene(horizonScene(std::string(air) + "\n" + refraction + "\ntime: {rate: 1 Hz, frames: 1, " + dateOf(secondOf(minutes * kMinute)) + "}"));
      return risenSun(0.0, sim.sun->toSun.z, sim.frame.earthRadius_m()).share;
    };
    EXPECT_GT(shareAt(-48.0, "refraction: standard"), 0.0) << air;
    EXPECT_EQ(shareAt(-52.0, "refraction: standard"), 0.0) << air;
    EXPECT_GT(shareAt(-15.0, ""), 0.0) << air;
    EXPECT_EQ(shareAt(-17.0, ""), 0.0) << air;
  }
}

TEST(Refraction, OfAScenario) {
  const std::string evening = "time: {rate: 1 Hz, frames: 1, date: 2026-06-21T18:00:00Z}";
  const Simulation without = scene(horizonScene("atmosphere: hazy_us76\n" + evening)),
                   none = scene(horizonScene("atmosphere: hazy_us76\nrefraction: none\n" + evening)),
                   standard = scene(horizonScene("atmosphere: hazy_us76\nrefraction: standard\n" + evening)),
                   given = scene(horizonScene("atmosphere: hazy_us76\nrefraction: {coefficient: 0.13}\n" + evening)),
                   bare = scene(horizonScene("refraction: standard\n" + evening));
  EXPECT_EQ(without.content, none.content);
  EXPECT_NE(without.content, standard.content);
  EXPECT_NE(given.content, standard.content);
  EXPECT_NEAR(standard.frame.refraction(), 0.163, 1e-3);
  EXPECT_NEAR(given.frame.refraction(), 0.13, 1e-12);
  EXPECT_NEAR(bare.frame.refraction(), 0.163, 1e-12);
  // What is given as geodetic is lifted: 33 km off by 0.13 d^2 / (2 R).
  const auto zOf = [](const Simulation& sim) { return sim.entities.front().motion.fixed().position.z; };
  figure("lift of a ship 33 km off [m]", zOf(given) - zOf(without), 0.13 * 33373.0 * 33373.0 / (2.0 * 6381000.0), 5e-3, "k d^2 / (2 R)");
  // The sun stands at its apparent place, with the layered air's own refraction and with a formula's.
  const auto elevation = [](const Simulation& sim) { return std::asin(sim.sun->toSun.z); };
  const double lift = (elevation(standard) - elevation(without)) / kMinute;
  EXPECT_GT(lift, 3.0);
  bound("lift of the sun by layered air off that by formula [arc minutes]", std::abs(lift - (elevation(bare) - elevation(without)) / kMinute), 0.2,
        "Bennett's 0.07, its inverse's 0.1; the profile");
  // Ways to space hold more air on the horizon, and nothing changes straight up.
  const auto air = [](const Simulation& sim, double sine) { return sim.air->amounts({0.0, sine, sim.frame.earthRadius_m()}, physics::kFar).amount[9]; };
  figure("air towards the horizon with refraction over without", air(standard, 0.0) / air(without, 0.0), 1.083, 0.005, "Bouguer's law integrated finely");
  EXPECT_NEAR(air(standard, 1.0) / air(without, 1.0), 1.0, 1e-6);
  // A sun at an azimuth and elevation is where it is said to be seen.
  const std::string fixed =
      "sun: {azimuth: 0 deg, elevation: 1 deg, temperature: 5772 K}\ncameras: [{name: c, film: {width: 2, height: 2}, field_of_view: 5 deg, "
      "aperture: 5 mm, heading: 0 deg, channels: [{name: a, response: {band: [0.5 um, 0.6 um]}}]}]\n";
  EXPECT_NEAR(std::asin(scene("refraction: standard\n" + fixed).sun->toSun.z), kDegree, 1e-12);
}

TEST(Refraction, WhatIsWrongIsSaid) {
  const auto refusal = [](const std::string& yaml) -> std::string {
    try {
      scene(horizonScene(yaml + "\ntime: {rate: 1 Hz, frames: 1, date: 2026-06-21T18:00:00Z}"));
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("refraction: some").find("write 'refraction: standard'"), std::string::npos) << refusal("refraction: some");
  EXPECT_NE(refusal("refraction: {coefficient: 1.2}").find("-2 to 0.9"), std::string::npos) << refusal("refraction: {coefficient: 1.2}");
  EXPECT_NE(refusal("refraction: {}").find("coefficient"), std::string::npos) << refusal("refraction: {}");
}

}  // namespace
}  // namespace pitviper::test
