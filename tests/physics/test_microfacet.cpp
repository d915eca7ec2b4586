// Facets by Fresnel's formulas, films on them and what lies beneath: energy, reciprocity, enclosures and pictures against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "materials/film_stack.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/hemisphere.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::shared_ptr<const Material> material(const std::string& components) {
  static std::vector<Simulation> kept;
  kept.push_back(
      scene("materials: {m: {components: [" + components +
            "]}}\ncameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 20 mm, position: [1 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], "
            "channels: [{name: v, response: {band: [0.6 um, 0.62 um]}}]}]\n"));
  return kept.back().materials.front();
}

const std::string kGold = "{reflection: microfacet, index: gold, roughness: 0.2}",
                  kPlastic = "{reflection: microfacet, index: 1.45, roughness: 0.15, pigment: 0.6}",
                  kFilm = "{reflection: microfacet, index: 1.45, roughness: 0.1, pigment: 0.3, layers: [{index: chrome_oxide, thickness: 270 nm}]}",
                  kRough = "{reflection: microfacet, index: aluminium, roughness: 0.6, slopes: normal}",
                  kPane = "{reflection: microfacet, index: 1.52, roughness: 0.01, thickness: 4 mm, layers: [{index: ito, thickness: 80 nm}]}";

// rho(theta) by brute force over light directions, for what is smooth enough: 1e-3.
TEST(Microfacet, HemisphericalIsTheIntegral) {
  for (const std::string& text : {kGold, kPlastic, kFilm, kRough}) {
    const auto m = material(text);
    for (double degrees : {0.0, 30.0, 60.0, 75.0}) {
      const double angle = degrees * kPi / 180.0, w = 0.61;
      figure(print("rho at %.0f deg of ", degrees) + text.substr(0, 60), m->reflectance(w, angle), bruteHemispherical(*m, w, angle), 4e-3,
             "uniform sums over 320,000 directions; tables of 1 and 3 deg");
    }
  }
}

// An ideal mirror of any roughness returns everything, one that absorbs nothing beneath its face too.
TEST(Microfacet, WhatAbsorbsNothingLosesNothing) {
  for (const char* slopes : {"ggx", "normal"})
    for (double roughness : {0.01, 0.1, 0.3, 0.7, 1.0}) {
      // n of 0.001 with k of 1000 mirrors to 4e-9.
      const auto mirror = material(print("{reflection: microfacet, index: {n: 0.001, k: 1000}, roughness: %g, slopes: %s}", roughness, slopes)),
                 white = material(print("{reflection: microfacet, index: 1.5, roughness: %g, slopes: %s, pigment: 1}", roughness, slopes));
      double worst = 0.0, most = 0.0;
      for (int degrees = 0; degrees <= 89; ++degrees)
        for (const auto& m : {mirror, white}) {
          const double rho = m->reflectance(0.6, degrees * kPi / 180.0);
          worst = std::max(worst, std::abs(1.0 - rho));
          most = std::max(most, rho - 1.0);
        }
      bound(print("loss of an ideal mirror and of a white body under glass, roughness %g, %s", roughness, slopes), worst, 1e-5, "rounding of n 0.001");
      bound("what they make", most, 1e-9, "rounding");
    }
}

TEST(Microfacet, IsReciprocal) {
  double worst = 0.0;
  for (const std::string& text : {kGold, kPlastic, kFilm, kRough}) {
    worst = std::max(worst, worstReciprocity(*material(text), 0.55, 2000));
  }
  bound("f(l, v) against f(v, l), relative", worst, 1e-5, "asked for");
}

// Seen on the mirrored side of a light, a plate shows E cos f; f of the facets at its peak is F(theta) / (4 pi a^2 cos^2 theta) where nothing is shadowed.
TEST(Microfacet, PictureOfAGlint) {
  const double theta = 30.0 * kPi / 180.0, a = 0.05;
  const auto seen = [&](const std::string& component, const std::string& accuracy) {
    const Frame f = renderFrame(scene(
        accuracy + "materials: {m: {components: [" + component +
        "]}}\nsun: {azimuth: 90 deg, elevation: 30 deg, irradiance: 100 W/(m2 um)}\nentities: [{name: p, shape: {model: plate, width: 40 m, height: 40 m}, "
        "material: m, temperature: 0 K}]\ncameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.02 deg, aperture: 20 mm, position: [8.660254 m, 0 "
        "m, "
        "-5 m], look_at: [0 m, 0 m, 0 m], channels: [{name: vis, response: {band: [0.6 um, 0.62 um]}}]}]\n"));
    return at(layer(f, "vis.radiance"), f, 4, 4);
  };
  const std::complex<double> n(0.2, 3.4);
  const double g1 = 2.0 / (1.0 + std::sqrt(1.0 + a * a * std::pow(std::tan(theta), 2.0))), shadow = g1 / (2.0 - g1),
               peak = filmPower({}, n, 0.61, std::sin(theta)).reflectance * shadow / (4.0 * kPi * a * a * std::pow(std::cos(theta), 2.0)),
               expected = 100.0 * 0.02 * std::cos(theta) * peak;
  for (const char* accuracy : {"", "accuracy: 1 %\n", "accuracy: reference\n"})
    figure(std::string("a metal plate's glint [W/(m2 sr)], ") + (*accuracy ? accuracy : "sampled"),
           seen(print("{reflection: microfacet, index: {n: 0.2, k: 3.4}, roughness: %g}", a), accuracy), expected, *accuracy ? 0.01 : 1e-3,
           "E cos F G / (4 pi a^2 cos^2): several facets' share left out; angles linear between half degrees");
  // Beneath glass, away from the glint: T(in) T(out) rho / (pi n^2 (1 - rho R)); R from inside by 1 - mean T / n^2.
  double meanT = 0.0;
  constexpr int kCells = 20000;
  for (int i = 0; i < kCells; ++i) meanT += (1.0 - filmPower({}, 1.5, 0.61, std::sqrt((i + 0.5) / kCells)).reflectance) / kCells;
  const double rho = 0.7, through = 1.0 - filmPower({}, 1.5, 0.61, 0.5).reflectance,
               body = through * through * rho / (kPi * 2.25 * (1.0 - rho * (1.0 - meanT / 2.25)));
  const auto off = [&](const std::string& accuracy) {
    const Frame f = renderFrame(scene(
        accuracy +
        "materials: {m: {components: [{reflection: microfacet, index: 1.5, roughness: 0.01, slopes: normal, pigment: 0.7}]}}\nsun: {azimuth: 90 deg, "
        "elevation: "
        "30 deg, irradiance: 100 W/(m2 um)}\nentities: [{name: p, shape: {model: plate, width: 40 m, height: 40 m}, material: m, temperature: 0 "
        "K}]\ncameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.02 deg, aperture: 20 mm, position: [8.660254 m, 0 m, 5 m], look_at: [0 m, 0 m, "
        "0 m], channels: [{name: vis, response: {band: [0.6 um, 0.62 um]}}]}]\n"));
    return at(layer(f, "vis.radiance"), f, 4, 4);
  };
  for (const char* accuracy : {"", "accuracy: 1 %\n", "accuracy: reference\n"})
    figure(std::string("pigment beneath glass [W/(m2 sr)], ") + (*accuracy ? accuracy : "sampled"), off(accuracy), 2.0 * std::cos(theta) * body,
           *accuracy ? 0.01 : 1e-3, "interfaced Lambertian, PHYSICS 4; angles linear between 3 degrees");
}

// In an enclosure of one temperature, everything shines as a black body, at any angle.
TEST(Microfacet, EnclosureIsFlat) {
  for (const std::string& text : {kGold, kPlastic, kFilm, kRough, kPane})
    for (const char* accuracy : {"", "accuracy: 1 %\n"}) {
      const Frame f = renderFrame(scene(
          std::string(accuracy) + "materials: {m: {components: [" + text +
          "]}}\nbackground: {temperature: 600 K}\nambient: {temperature: 600 K}\nentities: [{name: b, shape: {model: sphere, radius: 1 "
          "m, segments: 64}, material: m, temperature: 600 K}]\ncameras: [{name: c, film: {width: 33, height: 33}, field_of_view: 12 deg, aperture: 20 mm, "
          "position: [10 m, 0 m, 0 m], look_at: b, channels: [{name: mw, response: {band: [2 um, 2.4 um]}}]}]\n"));
      const double expected = blackBodyBand(2.0, 2.4, 600.0);
      double worst = 0.0;
      for (float x : layer(f, "mw.radiance").pixels) worst = std::max(worst, std::abs(static_cast<double>(x) / expected - 1.0));
      bound("off the black body in an enclosure, " + text.substr(0, 70) + (*accuracy ? ", planned" : ""), worst, *accuracy ? 2e-3 : 1e-4,
            *accuracy ? "1 % asked" : "asked for");
    }
}

// All that comes out of what goes in comes back: PHYSICS 4.
TEST(Microfacet, ApparentPigmentIsWhatComesOut) {
  const auto white = material("{reflection: microfacet, index: 1.5, roughness: 0.1, pigment: 1, pigment_is: apparent}");
  for (double degrees : {0.0, 45.0, 80.0})
    figure(print("a white apparent pigment beneath glass, %.0f deg", degrees), white->reflectance(0.6, degrees * kPi / 180.0), 1.0, 1e-9, "energy");
}

// Nothing of no thickness on nothing, up to grazing incidence itself.
TEST(Microfacet, AFilmOfNoThicknessIsNone) {
  const auto m = material("{reflection: microfacet, index: 1, roughness: 0.3, layers: [{index: 1.33, thickness: 0 um}]}");
  for (int degrees = 0; degrees < 89; ++degrees) EXPECT_NEAR(m->reflectance(0.6, degrees * kPi / 180.0), 0.0, 1e-3) << degrees;
  EXPECT_TRUE(std::isfinite(m->reflectance(0.6, 0.5 * kPi)));
}

double seenPlate(const std::string& component, const std::string& more = "") {
  const Frame f = renderFrame(scene(
      "accuracy: none\nmaterials: {m: {components: [" + component +
      "]}}\nambient: {radiance: \"1 W/(m2 sr um)\"}\nbackground: {radiance: \"3 W/(m2 sr um)\"}\nentities: [{name: p, shape: {model: plate, width: 40 m, "
      "height: 40 m}, material: "
      "m, "
      "temperature: 0 K}]\ncameras: [{name: c, film: {width: 3, height: 3}, field_of_view: 0.02 deg, aperture: 20 mm, position: [10 m, 0 m, 0 m], look_at: p, "
      "channels: [{name: c, response: {band: [" +
      (more.empty() ? std::string("0.448 um, 0.452 um") : more) + "]}}]}]\n"));
  return at(layer(f, "c.radiance"), f, 1, 1);
}

// A thickness out of a texture between its states, against the same thickness by a number.
TEST(Microfacet, StatesResolveFringes) {
  const std::string film = "{reflection: microfacet, index: aluminium, roughness: 0.1, layers: [{index: {n: 2.4, k: 0.05}}], film_thickness: ";
  const double bare = seenPlate("{reflection: microfacet, index: aluminium, roughness: 0.1}");
  double worst = 0.0;
  int k = 0;
  for (double um : {0.151, 0.253, 0.317, 0.389, 0.444}) {
    // The middle of a row of two is halfway, on a state or between two.
    const double half = 0.0531 + 0.0123 * k++;
    const double got = seenPlate(film + print("{rows: [[%.9g um, %.9g um]]}}", um - half, um + half)), want = seenPlate(film + print("%.9g um}", um));
    worst = std::max(worst, std::abs(got - want) / bare);
  }
  EXPECT_GT(worst, 1e-6);
  bound("a film's thickness from a texture against the same by a number, of the bare metal", worst, 0.01, "an eighth of 0.4 rad squared at 0.45 um");
}

// Half of a pane: half of what it lets through and half of what it mirrors; the rest is black.
TEST(Microfacet, APanesModifierIsItsShare) {
  const std::string pane = "{reflection: microfacet, index: 4, roughness: 0.01, thickness: 1 mm";
  figure("half of a pane over 3 W/(m2 sr um) under 1 [W/(m2 sr)]", seenPlate(pane + ", modifier: {rows: [[0.5, 0.5]]}}"), 0.5 * seenPlate(pane + "}"), 1e-6,
         "linear");
}

std::string refusal(const std::string& component) {
  try {
    material(component);
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(Microfacet, MistakesAreNamed) {
  const auto has = [](const std::string& component, const std::string& part) {
    const std::string said = refusal(component);
    EXPECT_NE(said.find(part), std::string::npos) << said;
    EXPECT_NE(said.find(":1:"), std::string::npos) << said;
  };
  has("{reflection: microfacet, index: {n: 1.5, k: -0.1}, roughness: 0.1}", "k");
  has("{reflection: microfacet, index: {table: [[1, 1.5, 0], [2, 1.5, -0.1]]}, roughness: 0.1}", "light would grow");
  has("{reflection: microfacet, index: 0, roughness: 0.1}", "n above 0");
  has("{reflection: microfacet, index: 1.5, roughness: 0.1, layers: [{index: 1.4, thickness: -5 nm}]}", "thickness");
  has("{reflection: microfacet, index: 1.5, roughness: 0.1, layers: [{index: 1.4}]}", "without a thickness");
  has("{reflection: microfacet, index: 1.5, roughness: 0.1, film_thickness: 100 nm}", "no layer takes");
  has("{reflection: microfacet, index: 1.5, thickness: 1 mm, roughness: 0.1, layers: [{index: ito}], film_thickness: {rows: [[1 nm, 100 nm]]}}",
      "a pane whose");
  has("{reflection: microfacet, index: 1.5, roughness: 0.1, layers: [{index: 2}], film_thickness: {rows: [[0 um, 50 um]]}}", "split the surface");
  has("{reflection: microfacet, index: silica_film, roughness: 0.1, pigment: 0.3}", "absorbs");
  has("{reflection: microfacet, index: {n: {wavelength: um, unit: \"1\", values: [[1, 1.5], [2, 1.5]]}, k: {wavelength: um, unit: \"1\", values: [[3, 0], [4, "
      "0]]}}, "
      "roughness: 0.1}",
      "no wavelength in common");
  has("{reflection: microfacet, index: golt, roughness: 0.1}", "did you mean 'gold'");
  has("{reflection: microfacet, index: {table: [[1, 1.5], [2, 1.5, 0]]}, roughness: 0.1}", "without three numbers");
  has("{reflection: microfacet, index: {sellmeier: [[1, 0.01]]}, roughness: 0.1}", "range");
  has("{reflection: microfacet, index: {table: [[1, 1.5, 0], [2, 1.5, 0]]}, roughness: 0.1, layers: [{index: {table: [[3, 1.5, 0], [4, 1.5, 0]]}, thickness: 1 "
      "um}]}",
      "no wavelength in common");
}

}  // namespace
}  // namespace pitviper::test
