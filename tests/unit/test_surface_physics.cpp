// Surfaces in arrays: what every surface has to keep, by materials of the library, and closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "scenarios/session/surface_physics.hpp"
#include "scenarios/view/material_text.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

using Values = std::vector<double>;

Libraries libraries() {
  const std::filesystem::path home = PITVIPER_SOURCE_DIR;
  return {home / "materials/library", home / "atmosphere/library", home / "sensors/library"};
}

SurfacePhysics surface(const std::string& name) { return SurfacePhysics(materialOf(name, libraries())); }

/// Of a kind each: a grey diffuser, diffuser and facets, facets of a metal, a coating, a sea.
constexpr const char* kOpaque[] = {"white_lambertian", "black_gloss_paint", "grey_aircraft_paint", "copper", "anodised_titanium", "sea_water"};

double bandMiddle(const SurfacePhysics& s) { return std::clamp(4.0, s.low_um(), s.high_um()); }

TEST(SurfacePhysics, LambertsLaw) {
  const SurfacePhysics white = surface("white_lambertian");
  const Values um{1.0, 4.0}, angles{0.0, 1.0, 0.5 * kPi};
  const Values share = white.reflectance(um, angles);
  ASSERT_EQ(share.size(), 6u);
  const std::vector<glm::dvec3> views{directionAt(0.0), directionAt(1.2, 2.0)};
  const Values f = white.brdf(um, directionAt(0.7), views);
  ASSERT_EQ(f.size(), 4u);
  for (std::size_t v = 0; v < 2; ++v)
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(f[v * 2 + i], share[i] / kPi, 1e-14);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(share[k], share[k % 2]);
  EXPECT_GT(share[0], 0.2);
}

// Law: f(l, v) = f(v, l).
TEST(SurfacePhysics, Reciprocity) {
  Numbers numbers(3);
  for (const char* name : kOpaque) {
    const SurfacePhysics s = surface(name);
    const Values um{bandMiddle(s)};
    double worst = 0.0, most = 0.0;
    for (int k = 0; k < 60; ++k) {
      const glm::dvec3 a = directionAt(numbers(0.0, 1.4), numbers(0.0, 6.0)), b = directionAt(numbers(0.0, 1.4), numbers(0.0, 6.0));
      const double there = s.brdf(um, a, std::vector{b})[0], back = s.brdf(um, b, std::vector{a})[0];
      worst = std::max(worst, std::abs(there - back) / std::max({there, back, 1e-3})), most = std::max(most, there);
    }
    EXPECT_GT(most, 1e-3) << name;
    bound(std::string("brdf of ") + name + ", there against back, relative", worst, 1e-12, "rounding");
  }
}

/// integral of f cos(theta) over all views, by Gauss points about the normal: of surfaces without narrow lobes.
double hemisphereOf(const SurfacePhysics& s, double um, double angle_rad) {
  const auto cosines = gaussLegendre(160, 0.0, 1.0);
  constexpr int kAzimuths = 360;
  double sum = 0.0;
  for (const QuadratureNode& n : cosines) {
    std::vector<glm::dvec3> views;
    for (int a = 0; a < kAzimuths; ++a) views.push_back(directionAt(std::acos(n.x), 2.0 * kPi * (a + 0.5) / kAzimuths));
    for (const double f : s.brdf(Values{um}, directionAt(angle_rad, 0.3), views)) sum += f * n.x * n.weight * 2.0 * kPi / kAzimuths;
  }
  return sum;
}

// Kirchhoff's law: what an opaque surface neither takes nor gives back is none: emissivity = 1 - integral of its BRDF cos.
TEST(SurfacePhysics, WhatIsNotReflectedIsEmitted) {
  for (const char* name : {"white_lambertian", "grey_aircraft_paint", "soil", "steel"}) {
    const SurfacePhysics s = surface(name);
    ASSERT_FALSE(s.material().given) << name;
    const double um = bandMiddle(s);
    for (const double angle : {0.0, 0.6, 1.2}) {
      const double emitted = s.emissivity(Values{um}, Values{angle})[0], reflected = s.reflectance(Values{um}, Values{angle})[0];
      EXPECT_NEAR(emitted + reflected + s.transmittance(Values{um}, Values{angle})[0], 1.0, 1e-12) << name;
      EXPECT_NEAR(hemisphereOf(s, um, angle), reflected, 4e-3) << name << " at " << angle << ": read linearly between angles";
    }
  }
}

TEST(SurfacePhysics, ArraysAreWhatTheirEntriesAre) {
  const SurfacePhysics s = surface("window_glass");
  const Values um{0.6, 2.0, 4.0}, angles{0.1, 1.3};
  for (const auto call : {&SurfacePhysics::reflectance, &SurfacePhysics::emissivity, &SurfacePhysics::transmittance}) {
    const Values all = (s.*call)(um, angles);
    ASSERT_EQ(all.size(), 6u);
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(all[a * 3 + i], (s.*call)(Values{um[i]}, Values{angles[a]})[0]);
  }
  EXPECT_GT(s.transmittance(Values{0.6}, Values{0.0})[0], 0.5);
}

/// 0.2 at 300 K, 0.4 at 400 K.
Simulation states() {
  return scene(
      "materials:\n  warm:\n    temperatures:\n"
      "      - {temperature: 300 K, components: [{reflection: lambertian, reflectance: 0.2}]}\n"
      "      - {temperature: 400 K, components: [{reflection: lambertian, reflectance: 0.4}]}\n"
      "  grey: {components: [{reflection: lambertian, reflectance: 0.3}]}\n  gas: {absorption: 0.002 /m}\n"
      "entities:\n  - {name: a, shape: {model: sphere, radius: 1 m}, material: warm, temperature: 350 K}\n"
      "  - {name: b, shape: {model: sphere, radius: 1 m}, material: grey, temperature: 350 K}\n"
      "  - {name: g, shape: {model: sphere, radius: 1 m}, material: gas, temperature: 900 K}\n"
      "cameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 1 mm, look_at: [9 m, 0 m, 0 m], channels: [{name: a, response: "
      "{band: [3 um, 5 um]}}]}]\n");
}

// Between two temperatures it is told at, a surface is linear.
TEST(SurfacePhysics, ByTemperature) {
  const Simulation sim = states();
  const auto warm = materialOf(sim, "warm");
  const auto known = SurfacePhysics(warm).states();
  ASSERT_TRUE(known.has_value());
  EXPECT_TRUE(known->isTemperature);
  EXPECT_EQ(known->low, 300.0);
  EXPECT_EQ(known->high, 400.0);
  for (const auto& [kelvin, share] : {std::pair{300.0, 0.2}, std::pair{325.0, 0.25}, std::pair{400.0, 0.4}}) {
    const SurfacePhysics s(warm, kelvin);
    EXPECT_NEAR(s.reflectance(Values{4.0}, Values{0.3})[0], share, 1e-12);
    EXPECT_NEAR(s.emissivity(Values{4.0}, Values{0.3})[0], 1.0 - share, 1e-12);
    EXPECT_NEAR(s.brdf(Values{4.0}, directionAt(0.2), std::vector{directionAt(0.5)})[0], share / kPi, 1e-12);
  }
  EXPECT_NEAR(SurfacePhysics(warm).reflectance(Values{4.0}, Values{0.3})[0], 0.2, 1e-12);
  EXPECT_FALSE(SurfacePhysics(materialOf(sim, "grey")).states().has_value());
}

// A film of any thickness that its texture has is the film of that thickness: between states as close as fringes ask for, an eighth of 0.4 rad squared off.
TEST(SurfacePhysics, ByThicknessOfAFilm) {
  const std::filesystem::path here = PITVIPER_SOURCE_DIR;
  const auto film = [&](const std::string& thickness) {
    return readMaterialText(
        "components: [{reflection: microfacet, index: aluminium, roughness: 0.1, layers: [{index: 2.4}], film_thickness: " + thickness + "}]", here,
        libraries());
  };
  const auto varied = film("{rows: [[0.2 um, 0.4 um]]}");
  const auto known = SurfacePhysics(varied).states();
  ASSERT_TRUE(known.has_value());
  EXPECT_FALSE(known->isTemperature);
  EXPECT_NEAR(known->low, 0.2, 1e-6);
  EXPECT_NEAR(known->high, 0.4, 1e-6);
  const Values um{0.62, 0.85}, angles{0.0, 1.1};
  double least = 1.0, most = 0.0;
  for (const double thickness_um : {0.27, 0.333}) {
    const Values mixed = SurfacePhysics(varied, thickness_um).reflectance(um, angles),
                 own = SurfacePhysics(film(print("%.9g um", thickness_um))).reflectance(um, angles);
    for (std::size_t k = 0; k < own.size(); ++k) {
      EXPECT_NEAR(mixed[k], own[k], 0.02) << thickness_um;
      least = std::min(least, own[k]), most = std::max(most, own[k]);
    }
  }
  EXPECT_GT(most - least, 0.2);
}

TEST(SurfacePhysics, OfTheLibraryAndOfAScenarioAreTheSame) {
  const Simulation sim = scene(
      "entities: [{name: b, shape: {model: sphere, radius: 1 m}, material: copper, temperature: 350 K}]\n"
      "cameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 1 mm, look_at: [9 m, 0 m, 0 m], channels: [{name: a, response: "
      "{band: [3 um, 5 um]}}]}]\n");
  const Values um{3.0, 5.0}, angles{0.0, 1.0};
  const Values expected = surface("copper").emissivity(um, angles);
  EXPECT_EQ(SurfacePhysics(materialOf(sim, "copper")).emissivity(um, angles), expected);
  EXPECT_EQ(SurfacePhysics(materialOf((libraries().materials / "copper.yaml").string(), libraries())).emissivity(um, angles), expected);
  // A substance has facets: gold's mirror between 3 and 5 um.
  EXPECT_GT(SurfacePhysics(materialOf("iron", libraries())).reflectance(Values{4.0}, Values{0.0})[0], 0.5);
}

TEST(SurfacePhysics, WhatIsRefused) {
  const Simulation sim = states();
  const SurfacePhysics grey(materialOf(sim, "grey")), copper = surface("copper");
  const auto why = [](const auto& call, const char* part) {
    const std::string said = refusalOf(call);
    EXPECT_TRUE(holds(said, part)) << "'" << said << "' has not '" << part << "'";
  };
  const std::vector<glm::dvec3> up{directionAt(0.0)};
  why([&] { materialOf(sim, "gray"); }, "there is no material 'gray'");
  why([&] { materialOf("coper", libraries()); }, "there is no material, substance or file 'coper'");
  why([&] { materialOf("../substances/iron", libraries()); }, "there is no material, substance or file");
  why([&] { SurfacePhysics(materialOf(sim, "gas")); }, "material 'gas' is a medium");
  why([&] { SurfacePhysics(materialOf(sim, "grey"), 300.0); }, "material 'grey' has no states");
  why([&] { SurfacePhysics(materialOf(sim, "warm"), 299.0); }, "in state 299 K; expected 300 to 400");
  why([&] { grey.brdf(Values{NAN}, up[0], up); }, "brdf(): wavelength_um[0] is nan");
  why([&] { grey.brdf(Values{4.0}, directionAt(2.0), up); }, "brdf(): light is [0.909");
  why([&] { grey.brdf(Values{4.0}, up[0], std::vector{up[0], glm::dvec3(0.0, 0.0, 2.0)}); }, "views[1] is [0, 0, 2]");
  why([&] { grey.brdf(Values{4.0}, {NAN, 0.0, 1.0}, up); }, "light is [nan");
  why([&] { grey.emissivity(Values{4.0}, Values{45.0}); }, "emissivity(): angle_rad[0] is 45; expected 0 to pi/2, from the normal; fix: angles are in radians");
  why([&] { grey.reflectance(Values{4.0}, Values{-0.1}); }, "reflectance(): angle_rad[0] is -0.1");
  why([&] { grey.transmittance(Values{4.0}, Values{NAN}); }, "transmittance(): angle_rad[0] is nan");
  why([&] { copper.emissivity(Values{4.0, 900.0}, Values{0.0}); }, "wavelength_um[1] is 900, where material ");
}

}  // namespace
}  // namespace pitviper::test
