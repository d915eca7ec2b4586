// The sun and the moon of a scenario by its date and origin.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/sky/sky_places.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0;

std::string sunScene(const std::string& time, const std::string& origin, const std::string& sun) {
  return (time.empty() ? "" : "time: {rate: 1 Hz, frames: 1, " + time + "}\n") + (origin.empty() ? "" : "origin: {" + origin + "}\n") + "sun: {" + sun + "}\n" +
         "cameras: [{name: c, film: {width: 2, height: 2}, field_of_view: 5 deg, aperture: 5 mm, position: [0 m, 0 m, 1 m], heading: 0 deg, "
         "channels: [{name: a, response: {band: [0.5 um, 0.6 um]}}]}]\n";
}

const std::string kGolden = "latitude: 39.742476 deg, longitude: -105.1786 deg, height: 1830.14 m";

TEST(SunByDate, IsWhereThePublishedExampleHasIt) {
  const Simulation sim = scene(sunScene("date: 2003-10-17T19:30:30", kGolden, "temperature: 5772 K"));
  const double elevation = std::asin(sim.sun->toSun.z) / kDegree, azimuth = std::atan2(sim.sun->toSun.x, sim.sun->toSun.y) / kDegree + 360.0;
  // Reda and Andreas 2008, NREL/TP-560-34302: 39.872046 degrees up without refraction, at 194.34024; its delta T of 67 s is 2.8 s off that day's UT1.
  bound("sun's elevation against NREL's worked example [arc seconds]", 3600.0 * std::abs(elevation - 39.872046), 12.0,
        "2.8 s of the earth's turn are 12 arc seconds east to west");
  bound("sun's azimuth against the same [arc seconds]", 3600.0 * std::abs(azimuth - 194.34024), 60.0, "2.8 s of the earth's turn at this height");
  const Spectrum usual(Spectrum::BlackBody{5772.0, 6.7943e-5});
  figure("sunlight on that day over that at 1 au", sim.sun->irradiance(0.55) / usual(0.55), 1.0 / (0.9965422974 * 0.9965422974), 1e-4,
         "the example's earth radius vector");
}

TEST(SunByDate, StartMovesIt) {
  const Simulation noon = scene(sunScene("date: 2026-06-21T12:00:00", kGolden, "temperature: 5772 K")),
                   later = scene(sunScene("date: 2026-06-21T11:00:00, start: 3600 s", kGolden, "temperature: 5772 K"));
  EXPECT_NEAR(glm::length(noon.sun->toSun - later.sun->toSun), 0.0, 1e-9);
}

TEST(SunByDate, TheMoonSendsWhatItReflects) {
  const Simulation sim =
      scene(sunScene("date: 2026-11-24T20:00:00", "latitude: 48.1 deg, longitude: 11.6 deg, height: 0 m", "body: moon, temperature: 5772 K"));
  std::string problem;
  const MoonLook moon = moonLook(*parseInstant("2026-11-24T20:00:00Z", problem), {48.1 * kDegree, 11.6 * kDegree, 0.0});
  EXPECT_NEAR(std::asin(sim.sun->toSun.z), moon.place.elevation_rad, 1e-9);
  const Spectrum usual(Spectrum::BlackBody{5772.0, 6.7943e-5});
  for (double um : {0.4, 0.55, 0.9, 2.2})
    figure("moonlight over sunlight at " + std::to_string(um) + " um", sim.sun->irradiance(um) / usual(um), moonlightShare(moon, um), 2e-3,
           "ROLO, linear between its bands");
  // Full moon lights with a quarter to a third of a lux: 1361 W/m2 of sunlight are 133 klx.
  const double lux = 133e3 * moonlightShare(moon, 0.555);
  EXPECT_GT(lux, 0.2);
  EXPECT_LT(lux, 0.45);
}

TEST(SunByDate, WhatIsMissingIsSaid) {
  const auto refusal = [](const std::string& yaml) -> std::string {
    try {
      scene(yaml);
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  const std::string date = "date: 2026-06-21T12:00:00";
  for (const auto& [yaml, said] : std::initializer_list<std::pair<std::string, std::string>>{
           {sunScene(date, kGolden, "azimuth: 10 deg, temperature: 5772 K"), "the sun has no elevation"},
           {sunScene("", kGolden, "temperature: 5772 K"), "add a date to 'time'"},
           {sunScene(date, "", "temperature: 5772 K"), "add 'origin: {latitude: 48 deg, longitude: 11 deg}'"},
           {sunScene("date: 1850-06-21T12:00:00", kGolden, "temperature: 5772 K"), "1900-01-01T00:00Z to 2100-01-01T00:00Z"},
           {sunScene("date: 2090-01-01T10:00:00, start: 1e9 s", kGolden, "temperature: 5772 K"), "correct 'start' or 'date'"},
           {sunScene(date, kGolden, "body: moon, azimuth: 10 deg, elevation: 10 deg, temperature: 5772 K"), "remove 'azimuth' and 'elevation'"}})
    EXPECT_NE(refusal(yaml).find(said), std::string::npos) << refusal(yaml);
}

}  // namespace
}  // namespace pitviper::test
