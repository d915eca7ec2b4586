// Every quantity of a channel against its definition, on a uniform field.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

// F/2, 100 um pixels, radiance 3 W/(m2 sr um) everywhere, band 4 to 5 um, optics 0.8 falling to 0.6, efficiency 0.5.
TEST(Quantities, FollowTheirDefinitions) {
  const auto sim = scene(
      "background: {radiance: 3 W/(m2 sr um)}\ncameras:\n  - name: c\n    film: {width: 5, height: 5, pitch: 100 um}\n    focal_length: 100 mm\n    aperture: "
      "50 mm\n"
      "    optics: {wavelength: um, unit: \"1\", values: [[4, 0.8], [5, 0.6]]}\n    exposure: 4 ms\n    position: [0 m, 0 m, 0 m]\n    heading: 0 deg\n    "
      "channels:\n"
      "      - {name: a, response: {band: [4 um, 5 um], value: 0.9}, quantum_efficiency: 0.5, gain: 2e6 V/W,\n"
      "         output: [radiance, radiance_per_um, photon_radiance, irradiance, photon_irradiance, flux, focal_irradiance, exposure, photons, electrons, "
      "volts]}\n"
      "      - {name: b, response: {band: [4 um, 5 um], value: 0.9}, gain: 40 V/(W/m2), output: volts}\n");
  const Frame f = renderFrame(sim);
  auto value = [&](const char* name) { return at(layer(f, name), f, 2, 2); };
  const double pixel = 1e-8 / 1e-2, aperture = 0.25 * kPi * 0.05 * 0.05;  // (pitch / focal length)^2 [sr]; on axis
  const double radiance = 3.0 * 0.9, behind = radiance * 0.7, perJoule = 1e-6 / (6.62607015e-34 * 299792458.0);
  // Photons: integral of lambda, and of lambda times the falling transmission 0.8 - 0.2 (lambda - 4).
  const double photons = radiance * 4.5 * perJoule, photonsBehind = radiance * perJoule * (1.6 * 4.5 - 0.2 * (125.0 - 64.0) / 3.0);
  const char* const why = "definition on a uniform field; the pixel's own size";
  figure("radiance [W/(m2 sr)]", value("a.radiance"), radiance, 1e-6, why);
  figure("radiance per um [W/(m2 sr um)]", value("a.radiance_per_um"), 3.0, 1e-6, why);
  figure("photon radiance [photon/(s m2 sr)]", value("a.photon_radiance"), photons, 1e-6, why);
  figure("irradiance on the aperture [W/m2]", value("a.irradiance"), radiance * pixel, 2e-6, why);
  figure("photon irradiance on the aperture", value("a.photon_irradiance"), photons * pixel, 2e-6, why);
  figure("pixel flux [W]", value("a.flux"), behind * pixel * aperture, 2e-6, why);
  figure("irradiance on the film [W/m2]", value("a.focal_irradiance"), kPi * behind / 16.0, 2e-6, "pi L tau/(4 F2), F/2");
  figure("exposure [J]", value("a.exposure"), behind * pixel * aperture * 4e-3, 2e-6, why);
  figure("photons", value("a.photons"), photonsBehind * pixel * aperture * 4e-3, 2e-6, why);
  figure("photoelectrons", value("a.electrons"), 0.5 * photonsBehind * pixel * aperture * 4e-3, 2e-6, why);
  figure("volts by V/W", value("a.volts"), 2e6 * behind * pixel * aperture, 2e-6, why);
  figure("volts by V/(W/m2)", value("b.volts"), 40.0 * kPi * behind / 16.0, 2e-6, why);
}

// One watt at 555 nm is 683 lumens; an equal-energy spectrum weighs the integral of V(lambda).
TEST(Quantities, Photometric) {
  const auto sim = scene(
      "background: {radiance: 1000 W/(m2 sr um)}\ncameras:\n  - name: c\n    film: {width: 5, height: 5, pitch: 100 um}\n    focal_length: 100 mm\n    "
      "aperture: 50 mm\n"
      "    position: [0 m, 0 m, 0 m]\n    heading: 0 deg\n    channels:\n"
      "      - {name: green, response: {band: [0.555 um, 0.5553 um]}, output: [radiance, luminance, illuminance, focal_illuminance]}\n"
      "      - {name: all, response: {band: [0.36 um, 0.83 um]}, output: luminance}\n      - {name: y, response: cie_y}\n");
  const Frame f = renderFrame(sim);
  auto value = [&](const char* name) { return at(layer(f, name), f, 2, 2); };
  figure("luminance per radiance at 555 nm [lm/W]", value("green.luminance") / value("green.radiance"), 683.0, 1e-4, "maximum luminous efficacy");
  figure("illuminance per luminance on axis [sr]", value("green.illuminance") / value("green.luminance"), 1e-6, 2e-6, "projected solid angle of the pixel");
  figure("film illuminance per luminance", value("green.focal_illuminance") / value("green.luminance"), kPi / 16.0, 2e-6, "pi/(4 F2), F/2");
  figure("luminance of an equal-energy spectrum [cd/m2]", value("all.luminance"), 683.0 * 1000.0 * 0.10685662, 2e-3,
         "integral of V: 106.857 nm (CIE 1931, 5 nm); 16 Gauss points");
  figure("observer as a response", value("y.radiance") * 683.0, value("all.luminance"), 2e-3, "the same table two ways");
}

// A mesh file is the shape it holds: the jet as OBJ against the jet built in.
TEST(Meshes, AFileIsTheShapeItHolds) {
  auto picture = [](const std::string& shape) {
    return renderFrame(scene("entities: [{name: j, shape: " + shape +
                             ", material: blackbody, temperature: 300 K, heading: 30 deg, pitch: 10 deg}]\n"
                             "cameras: [{name: c, film: {width: 64, height: 48}, field_of_view: 12 deg, aperture: 20 mm, position: [90 m, 0 m, 9 m], look_at: "
                             "j, truth: [entity, normal],"
                             " channels: [{name: a, response: {band: [8 um, 12 um]}}]}]\n"));
  };
  const Frame built = picture("{model: jet}"), read = picture("{model: mesh, file: assets/jet.obj, unit: 1 m}");
  size_t differ = 0;
  for (size_t p = 0; p < built.layers[0].pixels.size(); ++p) differ += built.layers[0].pixels[p] != read.layers[0].pixels[p];
  EXPECT_LE(differ, 4u) << "five digits in the file move an edge by micrometres";
  EXPECT_GT(sum(layer(built, "truth.entity")), 100.0);
}

}  // namespace
}  // namespace pitviper::test
