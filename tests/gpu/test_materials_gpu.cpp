// Material tables as the GPU reads them against the materials themselves in double precision.
#include <gtest/gtest.h>

#include <string>

#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string sphere(const std::string& material, const std::string& more = "") {
  return "materials: {m: " + material + "}\n" + more +
         "entities: [{name: s, shape: {model: sphere, radius: 1 m}, material: m, temperature: 320 K}]\n"
         "cameras: [{name: c, film: {width: 40, height: 40}, field_of_view: 12 deg, aperture: 5 mm, position: [12 m, 0 m, 1 m], look_at: [0 m, 0 m, 0 m],"
         " channels: [{name: a, response: {band: [3.2 um, 4.8 um]}}]}]\n";
}
/// A plate seen at 0 to 80 deg from its normal in one picture; its normal is the same everywhere, so that the view angle is known to 1e-6.
std::string plate(const std::string& material, const std::string& more = "") {
  return "materials: {m: " + material + "}\n" + more +
         "entities: [{name: s, shape: {model: plate, width: 400 m, height: 400 m}, material: m, temperature: 320 K}]\n"
         "cameras: [{name: c, film: {width: 60, height: 60}, field_of_view: 150 deg, aperture: 5 mm, position: [12 m, 0 m, 1 m], look_at: [0 m, 0 m, 1 m],"
         " channels: [{name: a, response: {band: [3.2 um, 4.8 um]}}]}]\n";
}
const std::string kLights =
    "sun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}\nlights: [{name: l, intensity: 40 W/(sr um), position: [3 m, 2 m, 4 m]}]\n";

// Emissivity over wavelength and view angle; a texture multiplies it, a reflection stands beside it.
TEST(MaterialTablesOnGpu, EmissivityTable) {
  const std::string values = "values: [[0.6, 0.5], [0.5, 0.55], [0.1, 0.3]]";
  const Worst plain = compare(scene(plate("{emission: {wavelength: [3 um, 5 um], angles: [{angle: view, count: 3, last: 90 deg}], " + values + "}}")), 1);
  EXPECT_GT(plain.covered, 3000);
  bound("GPU emissivity table against CPU double, entries on the grid", plain.error, 1e-5, "grid of 0.5 deg has all entries; single precision");
  const Worst odd = compare(scene(plate("{emission: {wavelength: [3 um, 5 um], angles: [{angle: view, count: 3, last: 41 deg}], " + values +
                                            ", modifier: {rows: [[1, 0.5], [0.2, 0.7]]}},"
                                            " components: [{reflection: lambertian, reflectance: 0.35}]}",
                                        kLights)),
                            1);
  EXPECT_GT(odd.covered, 3000);
  bound("GPU emissivity table to 41 deg with modifier and lights against CPU double", odd.error, 1e-5, "grid of 0.5 deg has 20.5 and 41 deg; single precision");
}

TEST(MaterialTablesOnGpu, EmissivityBetweenHalfDegrees) {
  const Worst w = compare(scene(plate("{emission: {wavelength: [3 um, 5 um], angles: [{angle: view, count: 7, last: 85 deg}], values: [[0.9, 0.9], [0.2, 0.2], "
                                      "[0.9, 0.9], [0.2, 0.2], [0.9, 0.9], [0.2, 0.2], [0.9, 0.9]]}}")),
                          1);
  bound("GPU emissivity table with entries every 14.17 deg against CPU double", w.error, 1e-5, "grid of 90 deg/216 has all entries; single precision");
}

// Two components on one angle, each in its own steps and to its own last entry.
TEST(MaterialTablesOnGpu, ComponentsInTheirOwnSteps) {
  auto table = [](const std::string& axis, const std::string& values) {
    return "{reflection: table, wavelength: [3 um, 5 um], angles: [{angle: " + axis + "}], values: " + values + "}";
  };
  const Worst w = compare(scene(sphere("{components: [" + table("specular, count: 3, last: 180 deg", "[[0.1, 0.12], [0.03, 0.05], [0.04, 0.02]]") + ", " +
                                           table("specular, count: 5, last: 40 deg", "[[0.1, 0.1], [0.02, 0.09], [0.06, 0.05], [0.01, 0.01], [0.03, 0.02]]") +
                                           ", " + table("incidence, count: 4, last: 60 deg", "[[0.03, 0.03], [0.05, 0.04], [0.01, 0.02], [0.02, 0.02]]") + "]}",
                                       kLights)),
                          1);
  EXPECT_GT(w.covered, 700);
  bound("GPU components of three axes in their own steps against CPU double", w.error, 1e-4,
        "common grids of 10 and 20 deg; hemispherical reflectance every 0.5 deg");
}

// A lobe of 2 deg: what is not reflected is emitted, and no pixel is negative.
TEST(MaterialTablesOnGpu, NarrowLobe) {
  const Worst w = compare(scene(sphere("{components: [{reflection: table, wavelength: [3 um, 5 um], angles: [{angle: half, count: 5, last: 2 deg}], values: "
                                       "[[150, 150], [100, 120], [60, 60], [20, 20], [0, 0]]}]}",
                                       kLights)),
                          1);
  EXPECT_GT(w.covered, 700);
  bound("GPU half-vector lobe of 2 deg against CPU double", w.error, 2e-4,
        "angles from single precision vectors, 1e-7 rad of steps of 0.009 rad, and single precision");
}

// Facets, films, what lies beneath them: tables over two pairs of angles in one material, a film's thickness from a texture, a pane.
TEST(MaterialTablesOnGpu, FilmedFacets) {
  const std::string kFilm = "layers: [{index: 2.2, thickness: 700 nm}]}";
  for (const std::string& component :
       {std::string("{reflection: microfacet, index: aluminium, roughness: 0.3}"),
        std::string("{reflection: microfacet, index: 1.5, roughness: 0.2, pigment: 0.5, layers: [{index: {n: 2.2, k: 0.01}, thickness: 700 nm}]}"),
        std::string("{reflection: microfacet, index: aluminium, roughness: 0.2, layers: [{index: {n: 2.2, k: 0.1}}], film_thickness: {rows: [[0.1 um, 0.4 um], "
                    "[0.3 um, 0.9 um]]}}"),
        "{reflection: microfacet, index: 1.5, roughness: 0.2, " + kFilm +
            ", {reflection: table, wavelength: [3 um, 5 um], angles: [{angle: incidence, count: 3, last: 60 deg}, {angle: view, count: 3, last: 60 deg}], "
            "values: "
            "[[[0.03, 0.03], [0.05, 0.04], [0.01, 0.02]], [[0.03, 0.01], [0.05, 0.04], [0.01, 0.02]], [[0.03, 0.03], [0.05, 0.04], [0.01, 0.02]]]}",
        std::string("{reflection: spectral_phong, diffuse: 0.2, specular: 0.5, exponent: {wavelength: um, unit: \"1\", values: [[3, 20], [5, 400]]}}"),
        std::string("{reflection: microfacet, index: {n: 1.5, k: 1e-5}, roughness: 0.1, thickness: 4 mm, layers: [{index: 2.2, thickness: 400 nm}]}")}) {
    const Worst w = compare(scene(sphere("{components: [" + component + "]}", kLights)), 1);
    EXPECT_GT(w.covered, 700);
    bound("GPU against CPU double, 99 of 100 pixels, " + component.substr(0, 80), w.percentile99,
          component.find("spectral_phong") == std::string::npos ? 1e-4 : 3e-4,
          "single precision; grids of 1 and 3 deg on both sides; spectral Phong: a table against the formula");
    bound("GPU against CPU double, worst pixel", w.error, 1e-3, "on a triangle's edge the two take normals of one or the other");
  }
}

}  // namespace
}  // namespace pitviper::test
