// The air between two places and towards the sky, in arrays: closed forms, a world of one temperature, and what LOWTRAN 7 gives.
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/absorber_table.hpp"
#include "atmosphere/homogeneous.hpp"
#include "scenarios/reader/library_air.hpp"
#include "scenarios/session/air_physics.hpp"
#include "sim/render/reference/reference_pixel.hpp"
#include "sim/world/view.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

using Values = std::vector<double>;

constexpr const char* kCamera =
    "cameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 1 mm, look_at: [1 m, 0 m, 0 m], channels: [{name: a, response: {band: "
    "[3.5 um, 4 um]}}]}]\n";

Simulation under(const std::string& air) { return scene(air + kCamera); }

Values axis(double low_um, double high_um, int count) {
  Values um;
  for (int k = 0; k < count; ++k) um.push_back(low_um + (high_um - low_um) * (k + 0.5) / count);
  return um;
}

double mean(const Values& values) {
  double sum = 0.0;
  for (const double v : values) sum += v / static_cast<double>(values.size());
  return sum;
}

// Law: tau = exp(-k R) (Beer and Lambert), L = B(T) (1 - tau); the sky of air without end is its black body.
TEST(AirPhysics, AirThatIsTheSameEverywhere) {
  const Simulation sim = under("atmosphere: {extinction: 0.2 /km, temperature: 280 K}\n");
  const Values um{3.0, 4.0, 10.0}, black = planckRadiance(um, Values{280.0});
  const glm::dvec3 from(1.0, 2.0, 30.0), to(1500.0, -2000.0, 900.0);
  const AirPath path = pathThrough(sim, from, to, um);
  const double range = glm::length(to - from), depth = 0.2e-3 * range;
  EXPECT_NEAR(path.range_m, range, 1e-9);
  for (std::size_t i = 0; i < um.size(); ++i) {
    EXPECT_NEAR(path.opticalDepth[i], depth, 1e-12);
    EXPECT_NEAR(path.transmittance[i], std::exp(-depth), 1e-12);
    EXPECT_NEAR(path.pathRadiance[i] / black[i], -std::expm1(-depth), 1e-10);
  }
  const Values sky = skyRadiance(sim, from, {0.0, 3.0, 1.0}, um);
  for (std::size_t i = 0; i < um.size(); ++i) EXPECT_NEAR(sky[i] / black[i], 1.0, 1e-10);
  const AirPath nowhere = pathThrough(sim, from, from, um);
  EXPECT_EQ(nowhere.transmittance, (Values{1.0, 1.0, 1.0}));
  EXPECT_EQ(nowhere.pathRadiance, (Values{0.0, 0.0, 0.0}));
}

TEST(AirPhysics, WithoutAir) {
  const Simulation sim = under("background: {temperature: 30 K}\n");
  const Values um{8.0, 12.0};
  const AirPath path = pathThrough(sim, {0, 0, 0}, {0, 5e3, 0}, um);
  EXPECT_EQ(path.transmittance, (Values{1.0, 1.0}));
  EXPECT_EQ(path.opticalDepth, (Values{0.0, 0.0}));
  EXPECT_EQ(path.pathRadiance, (Values{0.0, 0.0}));
  const Values sky = skyRadiance(sim, {0, 0, 0}, {0, 0, 1}, um), black = planckRadiance(um, Values{30.0});
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(sky[i] / black[i], 1.0, 1e-11);
  EXPECT_EQ(bandTransmittance(sim, {0, 0, 0}, {0, 5e3, 0}, {8.0, 12.0}, 300.0), 1.0);
}

// Kirchhoff: in a world of one temperature paths send B (1 - tau) and the sky is B, haze, cloud and all that they scatter included.
TEST(AirPhysics, AWorldOfOneTemperature) {
  const Simulation sim = under(
      "atmosphere: {library: hazy_us76, visibility: 5 km, temperature: 287.5 K, clouds: [{type: stratus, base: 600 m, top: 900 m}]}\n"
      "background: {temperature: 287.5 K}\nground: {material: blackbody, temperature: 287.5 K}\n");
  const Values um{3.5, 4.3, 8.5, 10.0, 11.9}, black = planckRadiance(um, Values{287.5});
  double worst = 0.0, worstSky = 0.0;
  for (const glm::dvec3& to : {glm::dvec3(0, 2e3, 10), glm::dvec3(0, 3e3, 1.5e3)}) {
    const AirPath path = pathThrough(sim, {0, 0, 10}, to, um);
    for (std::size_t i = 0; i < um.size(); ++i) worst = std::max(worst, std::abs(path.pathRadiance[i] / (black[i] * (1.0 - path.transmittance[i])) - 1.0));
  }
  for (const glm::dvec3& up : {glm::dvec3(0, 1, 0.1), glm::dvec3(0, 0, 1)}) {
    const Values sky = skyRadiance(sim, {0, 0, 10}, up, um);
    for (std::size_t i = 0; i < um.size(); ++i) worstSky = std::max(worstSky, std::abs(sky[i] / black[i] - 1.0));
  }
  bound("isothermal world, path radiance off B (1 - tau)", worst, 1e-5, "table of black bodies, doubling of layers");
  bound("isothermal world, sky off B", worstSky, 1e-5, "the same");
}

Libraries libraries() {
  const std::filesystem::path home = PITVIPER_SOURCE_DIR;
  return {home / "materials/library", home / "atmosphere/library", home / "sensors/library"};
}

// As `pitviper atmosphere` tells them, of its table.
TEST(AirPhysics, TransmittancesAreTheLibrarys) {
  const Simulation sim = under("atmosphere: hazy_us76\n");
  const AbsorberTable table = libraryAirTable("hazy_us76", libraries());
  const Values um = axis(3.0, 5.0, 100);
  const double earth_m = sim.frame.earthRadius_m();
  for (const double elevation : {0.0, 0.5}) {
    const glm::dvec3 along(0.0, std::cos(elevation), std::sin(elevation)), from(0.0, 0.0, 100.0);
    const AirPath path = pathThrough(sim, from, from + 5e3 * along, um), back = pathThrough(sim, from + 5e3 * along, from, um);
    const AbsorberAmounts amounts = table.amounts(100.0, std::sin(elevation), 5e3, earth_m);
    for (std::size_t i = 0; i < um.size(); ++i) {
      EXPECT_NEAR(path.transmittance[i], table.transmittance(um[i], amounts), 1e-9);
      EXPECT_NEAR(path.opticalDepth[i], -std::log(path.transmittance[i]), 1e-9 * (1.0 + path.opticalDepth[i]));
      EXPECT_NEAR(back.transmittance[i], path.transmittance[i], 1e-6) << "quadrature from the other end";
    }
  }
}

// Band means of thermal path radiance that LOWTRAN 7 rev 4.2 (AFGL 1992, US Government work) gives at every 5 1/cm: US standard 1976, rural haze of 23 km. It
// takes all that scatters for black; here some of it turns the light of a colder sky instead, which is worth 1 % of these.
TEST(AirPhysics, PathRadianceIsLowtrans) {
  const Simulation sim = under("atmosphere: hazy_us76\nground: {material: blackbody, temperature: 288.15 K}\n");
  const struct { double range_m, mwMean, lwMean; } kLevel[] = {{1e3, 0.25932, 0.98827}, {5e3, 0.42047, 2.9501}, {1e4, 0.49251, 4.4558}};
  for (const auto& p : kLevel) {
    const glm::dvec3 to(0.0, p.range_m, 0.0);
    figure(print("level path of %g km, 3-5 um [W/(m2 sr um)]", 1e-3 * p.range_m), mean(pathThrough(sim, {0, 0, 0}, to, axis(3.0, 5.0, 400)).pathRadiance),
           p.mwMean, 0.03, "LOWTRAN 7: fit of transmittance, light scattered again");
    figure(print("level path of %g km, 8-12 um [W/(m2 sr um)]", 1e-3 * p.range_m), mean(pathThrough(sim, {0, 0, 0}, to, axis(8.0, 12.0, 200)).pathRadiance),
           p.lwMean, 0.03, "LOWTRAN 7: the same");
  }
}

// Sunlight that air scatters: none by night, blue by day, brighter towards the sun.
TEST(AirPhysics, Daylight) {
  const std::string air = "atmosphere: hazy_us76\n", ground = "ground: {material: soil, temperature: 290 K}\n";
  const Simulation night = under(air + ground), day = under(air + "sun: {azimuth: 0 deg, elevation: 40 deg, irradiance: solar_e490}\n" + ground);
  const Values um{0.45, 0.55, 0.7, 10.0};
  const Values dark = skyRadiance(night, {0, 0, 2}, {0, -0.6, 0.8}, um), away = skyRadiance(day, {0, 0, 2}, {0, -0.6, 0.8}, um),
               towards = skyRadiance(day, {0, 0, 2}, {0, 1, 1}, um);
  const double blueShare = day.sun->irradiance(0.45) / day.sun->irradiance(0.7);
  EXPECT_LT(dark[1], 1e-9);
  EXPECT_GT(away[0] / away[2], 1.5 * blueShare);
  EXPECT_GT(towards[1], 2.0 * away[1]);
  EXPECT_NEAR(away[3] / dark[3], 1.0, 1e-3);
  const glm::dvec3 to(0.0, -6e3, 2.0);
  const AirPath path = pathThrough(day, {0, 0, 2}, to, um), unlit = pathThrough(night, {0, 0, 2}, to, um);
  EXPECT_GT(path.pathRadiance[1], 1.0);
  EXPECT_LT(unlit.pathRadiance[1], 1e-9);
  EXPECT_EQ(path.transmittance, unlit.transmittance);
}

// A path to the edge of the air, and what lies behind it through it, is the sky.
TEST(AirPhysics, TheSkyIsAPathAndWhatLiesBehind) {
  const Simulation sim = under(
      "atmosphere: hazy_us76\nbackground: {temperature: 200 K}\nsun: {azimuth: 70 deg, elevation: 30 deg, irradiance: solar_e490}\n"
      "ground: {material: soil, temperature: 290 K}\n");
  const Values um{0.8, 3.8, 9.0}, behind = planckRadiance(um, Values{200.0});
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.3, 0.4, 0.5));
  const AirPath path = pathThrough(sim, {0, 0, 50}, glm::dvec3(0, 0, 50) + 3e5 * up, um);
  const Values sky = skyRadiance(sim, {0, 0, 50}, up, um);
  for (std::size_t i = 0; i < um.size(); ++i) EXPECT_NEAR((path.pathRadiance[i] + behind[i] * path.transmittance[i]) / sky[i], 1.0, 1e-4) << um[i];
}

// What the reference draws of a pixel, in every term and stream: the sky, and a body of 0 K at the end of a path.
TEST(AirPhysics, IsWhatTheReferenceDraws) {
  const std::string air =
      "atmosphere: {library: hazy_us76, visibility: 10 km}\nsun: {azimuth: 70 deg, elevation: 30 deg, irradiance: solar_e490}\n"
      "background: {temperature: 100 K}\nground: {material: soil, temperature: 290 K}\n";
  for (const bool sky : {true, false}) {
    const Simulation sim =
        scene(air + "entities: [{name: b, shape: {model: sphere, radius: 20 m}, material: blackbody, temperature: 0 K, position: [0 m, 2 km, 600 m]}]\n" +
              "cameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 0.01 deg, aperture: 1 mm, position: [0 m, 0 m, 100 m], look_at: " +
              (sky ? "[1 km, 2 km, 600 m]" : "[0 m, 2 km, 600 m]") +
              ", channels: [{name: a, response: {band: [0.5 um, 0.51 um]}}, {name: b, response: {band: [3.8 um, 3.9 um]}}]}]\n");
    SpectralSampling fine;
    fine.reference = true;
    const Camera& camera = sim.cameras.front();
    const Plan plan = makePlan(sim, camera.outputs, fine, {});
    const WorldState state = advance(sim, 0.0);
    const std::vector<char> drawn(1, 1);
    const ReferencePixel pixel = ReferenceShader(sim, plan, cameraView(camera, state, 1), state, drawn).pixel(0, 0);
    Values um;
    for (const SpectralNode& n : plan.nodes) um.push_back(n.members.front().wavelength_um);
    ASSERT_GT(um.size(), 10u);
    const glm::dvec3 from(0, 0, 100), along = glm::normalize(glm::dvec3(sky ? 1e3 : 0.0, 2e3, 500.0));
    const Values own = sky ? skyRadiance(sim, from, along, um) : pathThrough(sim, from, from + pixel.range_m * along, um).pathRadiance;
    double worst = 0.0;
    for (std::size_t i = 0; i < um.size(); ++i) worst = std::max(worst, std::abs(own[i] / pixel.radiance[i] - 1.0));
    bound(sky ? "sky off the reference's pixel of it" : "path radiance off the reference's pixel of a body of 0 K", worst, 1e-6, "place of the pixel's middle");
  }
}

// Bodies, their materials' data and fields are not the air's: a body in the way takes nothing.
TEST(AirPhysics, BodiesAreLeftOut) {
  const std::string air = "atmosphere: {extinction: 0.2 /km, temperature: 280 K}\nground: {material: blackbody, temperature: 290 K}\n";
  const Simulation sim =
      under(air +
            "materials: {thin: {components: [{reflection: lambertian, reflectance: {wavelength: um, unit: \"1\", values: [[3.4, 0.2], [4.1, 0.3]]}}]}}\n"
            "entities: [{name: b, shape: {model: sphere, radius: 5 m}, material: thin, temperature: 300 K, position: [50 m, 0 m, 0 m]}]\n");
  const Values um{3.0, 10.0};
  const AirPath path = pathThrough(sim, {0, 0, 0}, {100, 0, 0}, um), bare = pathThrough(under(air), {0, 0, 0}, {100, 0, 0}, um);
  EXPECT_EQ(path.transmittance, bare.transmittance);
  EXPECT_EQ(path.pathRadiance, bare.pathRadiance);
}

// Two halves of a band, of extinctions that differ: each with its share of the source's light, by the series of the classical integral.
TEST(AirPhysics, BandsWeighWhatTheSourceSends) {
  Simulation sim = under("");
  HomogeneousAir air;
  air.extinction_per_m = Spectrum(Spectrum::Table{{2.0, 4.0, 4.0, 6.0}, {1e-4, 1e-4, 1e-3, 1e-3}, Outside::Error, "two halves"});
  sim.air = makeHomogeneousAir(air);
  for (const double kelvin : {300.0, 1000.0}) {
    const double low = blackBodyBand(3.0, 4.0, kelvin), high = blackBodyBand(4.0, 5.0, kelvin),
                 expected = (low * std::exp(-0.2) + high * std::exp(-2.0)) / (low + high);
    // Bins of 5 1/cm, 1 % of the wavelength at most: (x / 24) (x 0.002)^2, x = 16.
    figure(print("transmittance of 3-5 um over 2 km for a body of %g K", kelvin), bandTransmittance(sim, {0, 0, 0}, {2e3, 0, 0}, {3.0, 5.0}, kelvin), expected,
           1e-4, "shares of the classical series");
  }
  // The same air everywhere is the same for all bodies.
  const Simulation even = under("atmosphere: {extinction: 0.3 /km}\n");
  EXPECT_NEAR(bandTransmittance(even, {0, 0, 0}, {2e3, 0, 0}, Responsivity(Values{3.0, 4.0, 5.0}, Values{0.0, 1.0, 0.0}), 500.0), std::exp(-0.6), 1e-12);
}

TEST(AirPhysics, WhatIsRefused) {
  const Simulation sim = under("atmosphere: hazy_us76\nground: {material: soil, temperature: 290 K}\n");
  const Values um{4.0};
  const auto why = [](const auto& call, const char* part) {
    const std::string said = refusalOf(call);
    EXPECT_TRUE(holds(said, part)) << "'" << said << "' has not '" << part << "'";
  };
  why([&] { pathThrough(sim, {0, 0, 10}, {0, 6e4, -270}, um); }, "path(): the earth stands between the two places");
  why([&] { pathThrough(sim, {0, 0, 10}, {0, 6e4, -270}, um); }, "raise one of the places");
  why([&] { bandTransmittance(sim, {0, 0, 10}, {0, 6e4, -270}, {3.5, 4.5}, 300.0); }, "band_transmittance(): the earth stands");
  why([&] { pathThrough(sim, {0, 0, NAN}, {0, 1e3, 10}, um); }, "path(): from[2] is nan");
  why([&] { pathThrough(sim, {0, 0, 10}, {0, INFINITY, 10}, um); }, "path(): to[1] is inf");
  why([&] { pathThrough(sim, {0, 0, 10}, {0, 1e3, 10}, Values{4.0, NAN}); }, "path(): wavelength_um[1] is nan");
  why([&] { pathThrough(sim, {0, 0, 10}, {0, 1e3, 10}, Values{4.0, 14.9}); }, "the atmosphere has no data");
  why([&] { skyRadiance(sim, {0, 0, 10}, {0, 1, -0.1}, um); }, "sky_radiance(): a direction 5.7");
  why([&] { skyRadiance(sim, {0, 0, 10}, {0, 0, 0}, um); }, "a direction of length 0");
  why([&] { skyRadiance(sim, {0, 0, 10}, {0, NAN, 1}, um); }, "sky_radiance(): direction[1] is nan");
  why([&] { bandTransmittance(sim, {0, 0, 10}, {0, 1e3, 10}, {3.5, 4.5}, 0.0); }, "a source of 0 K");
  why([&] { bandTransmittance(sim, {0, 0, 10}, {0, 1e3, 10}, {3.5, 4.5}, NAN); }, "a source of nan K");
  why([&] { bandTransmittance(sim, {0, 0, 10}, {0, 1e3, 10}, {10.0, 30.0}, 300.0); }, "the atmosphere has no data for channel 'responsivity'");
}

}  // namespace
}  // namespace pitviper::test
