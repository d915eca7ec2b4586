// The whole pipeline, scenario to calibrated pixel, against closed forms. Every tolerance says where its error comes from.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

// A camera of 33 x 33 pixels 10 m in front (east) of the origin, looking west at it; its middle pixel lies on the axis.
std::string camera(const std::string& more, const std::string& channels, const std::string& position = "[10 m, 0 m, 0 m]") {
  return "cameras:\n  - name: c\n    film: {width: 33, height: 33}\n    field_of_view: 2 deg\n    aperture: 20 mm\n    position: " + position +
         "\n    look_at: [0 m, 0 m, 0 m]\n" + more + "    channels:\n" + channels;
}
const std::string kMw = "      - {name: mw, response: {band: [3 um, 5 um]}}\n";

// Source of error: 16 Gauss points (below 1e-9 here) and single precision.
TEST(ClosedForms, BlackPlateInBand) {
  for (double t : {220.0, 300.0, 1000.0, 3000.0}) {
    const auto sim = scene("entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: blackbody, temperature: " + std::to_string(t) +
                           " K}]\n" + camera("", "      - {name: mw, response: {band: [3 um, 5 um]}}\n      - {name: lw, response: {band: [8 um, 12 um]}}\n"));
    const Frame f = renderFrame(sim);
    figure("black plate, " + std::to_string(static_cast<int>(t)) + " K, 3-5 um [W/(m2 sr)]", at(layer(f, "mw.radiance"), f, 16, 16), blackBodyBand(3, 5, t),
           1e-5, "series of the Planck integral; single precision");
    figure("black plate, " + std::to_string(static_cast<int>(t)) + " K, 8-12 um [W/(m2 sr)]", at(layer(f, "lw.radiance"), f, 16, 16), blackBodyBand(8, 12, t),
           1e-5, "series of the Planck integral; single precision");
  }
}

const std::string kLitPlate =
    "materials: {grey: {components: [{reflection: lambertian, reflectance: 0.4}]}}\n"
    "lights: [{name: lamp, intensity: 50 W/(sr um), visible: false, position: [3 m, 4 m, 0 m]}]\n"
    "entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: grey, temperature: 0 K}]\n";

// L = rho/pi I cos(theta)/d^2 x 2 um; light at 5 m, cos = 0.6. Error: the middle pixel's finite size (1e-6).
TEST(ClosedForms, LambertianPlateUnderPointLight) {
  const Frame f = renderFrame(scene(kLitPlate + camera("", kMw)));
  figure("Lambertian plate under a point light [W/(m2 sr)]", at(layer(f, "mw.radiance"), f, 16, 16), 0.4 / kPi * 50.0 * 0.6 / 25.0 * 2.0, 1e-5,
         "rho/pi I cos/d2; single precision");
}

TEST(ClosedForms, LambertianPlateInAirBothLegs) {
  const double g = 0.05, t = 300.0;
  const auto sim = scene(
      "atmosphere: {extinction: 50 /km, temperature: 280 K}\n"
      "materials: {grey: {components: [{reflection: lambertian, reflectance: 0.4}]}}\n"
      "lights: [{name: lamp, intensity: 50 W/(sr um), visible: false, position: [3 m, 4 m, 0 m]}]\n"
      "entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: grey, temperature: 300 K}]\n" +
      camera("", kMw));
  const Frame f = renderFrame(sim);
  const double expected = 0.4 / kPi * 50.0 * 0.6 / 25.0 * 2.0 * std::exp(-g * 15.0) + 0.6 * blackBodyBand(3, 5, t) * std::exp(-g * 10.0) -
                          blackBodyBand(3, 5, 280.0) * std::expm1(-g * 10.0);
  figure("lit, warm plate in air, both legs [W/(m2 sr)]", at(layer(f, "mw.radiance"), f, 16, 16), expected, 1e-5,
         "Beer-Lambert on d + R, path radiance; single precision");
}

// A sphere's irradiance at R from its centre is pi L r^2/R^2 exactly. Error: facets (equal area, 256 segments: 6e-5) and the
// silhouette on 4 x 4 subpixels of 257 pixels.
TEST(ClosedForms, ResolvedSphereFlux) {
  const auto sim = scene(
      "entities: [{name: s, shape: {model: sphere, radius: 1 m, segments: 256}, material: blackbody, temperature: 500 K}]\n"
      "cameras:\n  - {name: c, film: {width: 257, height: 257}, field_of_view: 14 deg, aperture: 20 mm, position: [10 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], "
      "samples: 4,\n"
      "     channels: [{name: mw, response: {band: [3 um, 5 um]}, output: flux}]}\n");
  const Frame f = renderFrame(sim);
  const double expected = blackBodyBand(3, 5, 500) * kPi / 100.0 * kPi * 0.01 * 0.01;
  figure("resolved sphere, total flux [W]", sum(layer(f, "mw.flux")), expected, 1e-3, "pi r2 L/R2 x aperture; facets and silhouette on subpixels");
}

// Lambertian radiance does not depend on the angle of view, emitted or reflected, and the solid angle of the aperture and the
// fragment's area are what back projection says.
TEST(ClosedForms, TiltedPlate) {
  for (double tilt : {0.0, 30.0, 60.0, 80.0, 85.0, 89.0, 89.9}) {
    const double a = tilt * kPi / 180.0;
    const auto sim = scene(
        "materials: {grey: {components: [{reflection: lambertian, reflectance: 0.4}]}}\n"
        "sun: {azimuth: 90 deg, elevation: 0 deg, irradiance: 100 W/(m2 um)}\n"
        "entities: [{name: p, shape: {model: plate, width: 800 m, height: 800 m}, material: grey, temperature: 300 K, heading: 90 deg}]\n" +
        camera("    truth: [area, solid_angles, range]\n", kMw,
               "[" + std::to_string(10 * std::cos(a)) + " m, " + std::to_string(10 * std::sin(a)) + " m, 0 m]"));
    const Frame f = renderFrame(sim);
    const double expected = 0.6 * blackBodyBand(3, 5, 300) + 0.4 / kPi * 100.0 * 2.0;
    const std::string name = "plate seen at " + std::to_string(tilt).substr(0, 4) + " deg";
    figure(name + " [W/(m2 sr)]", at(layer(f, "mw.radiance"), f, 16, 16), expected, 1e-5, "same radiance at any angle; single precision");
    const double pixel = std::pow(2.0 * std::tan(kPi / 180.0) / 33.0, 2);
    figure(name + ", fragment area [m2]", at(layer(f, "truth.area"), f, 16, 16), pixel * 100.0 / std::cos(a), 1e-3,
           "w R2/cos(theta_v); float coordinates at grazing");
    figure(name + ", aperture from fragment [sr]", at(layer(f, "truth.solid_angle_of_aperture"), f, 16, 16), kPi * 1e-4 / 100.0, 1e-4, "A cos(psi)/R2");
  }
}

// In a narrow band photons are energy times lambda/(h c).
TEST(ClosedForms, PhotonsAgainstEnergy) {
  const auto sim = scene("entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: blackbody, temperature: 700 K}]\n" +
                         camera("    exposure: 2 ms\n",
                                "      - {name: n, response: {band: [3.999 um, 4.001 um]}, output: [exposure, photons]}\n"
                                "      - {name: w, response: {band: [3 um, 5 um]}, quantum_efficiency: 0.5, output: [photons, electrons]}\n"));
  const Frame f = renderFrame(sim);
  figure("photons per joule at 4 um", at(layer(f, "n.photons"), f, 16, 16) / at(layer(f, "n.exposure"), f, 16, 16), 4e-6 / (6.62607015e-34 * 299792458.0), 1e-6,
         "lambda/(h c)");
  figure("electrons per photon", at(layer(f, "w.electrons"), f, 16, 16) / at(layer(f, "w.photons"), f, 16, 16), 0.5, 1e-6, "quantum efficiency");
  // Photon radiance by a trapezoidal sum written here.
  double photons = 0.0;
  const int n = 20000;
  for (int i = 0; i <= n; ++i) {
    const double w = (3.0 + 2.0 * i / n) * 1e-6;
    photons +=
        (i == 0 || i == n ? 0.5 : 1.0) * 2.0 * 299792458.0 / std::pow(w, 4) / std::expm1(6.62607015e-34 * 299792458.0 / (w * 1.380649e-23 * 700.0)) * 2e-6 / n;
  }
  const double pixel = std::pow(2.0 * std::tan(kPi / 180.0) / 33.0, 2);
  figure("photons on a pixel, 3-5 um, 700 K", at(layer(f, "w.photons"), f, 16, 16), photons * pixel * kPi * 1e-4 * 2e-3, 1e-5,
         "2 c/lambda4/(exp x - 1) summed; single precision");
}

// Focal-plane irradiance pi L tau/(4 F^2) cos^4(psi).
TEST(ClosedForms, FocalPlaneIrradiance) {
  const auto sim = scene(
      "background: {temperature: 300 K}\n"
      "cameras:\n  - {name: c, film: {width: 101, height: 101, pitch: 100 um}, focal_length: 10 mm, aperture: 5 mm, optics: 0.8, position: [0 m, 0 m, 0 m], "
      "heading: 0 deg,\n"
      "     channels: [{name: lw, response: {band: [8 um, 12 um]}, output: focal_irradiance}]}\n");
  const Frame f = renderFrame(sim);
  const double axis = kPi * blackBodyBand(8, 12, 300) * 0.8 / (4.0 * 2.0 * 2.0);
  figure("focal-plane irradiance on axis, F/2 [W/m2]", at(layer(f, "lw.focal_irradiance"), f, 50, 50), axis, 1e-4, "pi L tau/(4 F2); the pixel's own size");
  const double tangent = 40.0 * 100e-6 / 10e-3;
  figure("focal-plane irradiance 21.8 deg off axis [W/m2]", at(layer(f, "lw.focal_irradiance"), f, 90, 50), axis / std::pow(1 + tangent * tangent, 2), 1e-4,
         "cos4(psi)");
}

TEST(ClosedForms, SumOfPixelSolidAngles) {
  const auto sim = scene(
      "background: {temperature: 300 K}\n"
      "cameras:\n  - {name: c, film: {width: 90, height: 60}, field_of_view: 130 deg, aperture: 5 mm, position: [0 m, 0 m, 0 m], heading: 0 deg, channels: "
      "[{name: lw, response: {band: [8 um, 12 um]}}]}\n");
  const CameraImage image = renderImage(sim);
  double total = 0.0;
  for (double w : image.solidAngles->plain_sr) total += w;
  const double h = 65.0 * kPi / 180.0, v = std::atan(std::tan(h) * 60.0 / 90.0);
  figure("sum of pixel solid angles, 130 deg field [sr]", total, 4.0 * std::asin(std::sin(h) * std::sin(v)), 1e-5,
         "4 asin(sin(h/2) sin(v/2)); 3x3 Gauss points per pixel");
}

// A point light in view: flux I tau A/R^2, all of it in one pixel, wherever that is.
TEST(ClosedForms, PointLightInView) {
  const auto sim = scene(
      "atmosphere: {extinction: 0.5 /km}\n"
      "lights: [{name: flare, intensity: 900 W/(sr um), position: [-990 m, 12 m, -7 m]}]\n" +
      camera("", "      - {name: mw, response: {band: [3 um, 5 um]}, output: [flux, irradiance]}\n"));
  const Frame f = renderFrame(sim);
  const double r2 = 1000.0 * 1000.0 + 12.0 * 12.0 + 49.0, cosPsi = 1000.0 / std::sqrt(r2);
  figure("point light, flux [W]", sum(layer(f, "mw.flux")), 900.0 * 2.0 * std::exp(-0.5e-3 * std::sqrt(r2)) * kPi * 1e-4 * cosPsi / r2, 1e-5, "I tau A cos/R2");
}

// The same where pixels are as coarse as they get: 9 over 120 degrees.
TEST(ClosedForms, PointLightInCoarsePixels) {
  const auto sim = scene(
      "lights: [{name: flare, intensity: 900 W/(sr um), position: [-1000 m, 0 m, 700 m]}]\n"
      "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 120 deg, aperture: 20 mm, position: [0 m, 0 m, 0 m], heading: 270 deg, channels: "
      "[{name: mw, response: {band: [3 um, 5 um]}, output: irradiance}]}]\n");
  const double r2 = 1.49e6;
  figure("point light in pixels of 13 deg, irradiance [W/m2]", sum(layer(renderFrame(sim), "mw.irradiance")), 1800.0 / r2 * 1000.0 / std::sqrt(r2), 1e-6,
         "I cos/R2");
}

// A lamp of lines upon a smooth part: E = sum of P r(lambda) and integral of the smooth part, each as if it were alone.
TEST(ClosedForms, CompositeSpectrum) {
  for (const char* accuracy : {"", "accuracy: 0.1 %\n"}) {
    const auto sim = scene(
        accuracy +
        std::string("materials: {m: {components: [{reflection: lambertian, reflectance: {wavelength: nm, unit: \"1\", values: [[400, 0.1], [700, 0.7]]}}]}}\n"
                    "lights: [{name: lamp, position: [0 m, 0 m, 10 m], intensity: {wavelength: nm, unit: W/(sr nm), values: [[450, 0.02], [650, 0.06]], lines: "
                    "[[546.1, 5], "
                    "[577, 2], [579.1, 2.5]]}}]\n"
                    "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: m, temperature: 1 K, pitch: 90 deg}]\n"
                    "cameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 0.01 deg, aperture: 5 mm, position: [0 m, 1 m, 20 m], look_at: [0 m, 0 m, "
                    "0 m], channels: "
                    "[{name: v, response: {wavelength: nm, unit: \"1\", values: [[500, 0.2], [600, 1]]}}]}]\n"));
    const auto reflectance = [](double nm) { return 0.1 + 0.6 * (nm - 400.0) / 300.0; };
    const auto response = [](double nm) { return 0.2 + 0.8 * (nm - 500.0) / 100.0; };
    double sum = 0.0;
    for (const auto& [nm, power] : {std::pair{546.1, 5.0}, std::pair{577.0, 2.0}, std::pair{579.1, 2.5}}) sum += power * reflectance(nm) * response(nm);
    constexpr int kSteps = 2000;  // Simpson's rule, exact for cubes
    for (int i = 0; i <= kSteps; ++i) {
      const double nm = 500.0 + 100.0 * i / kSteps, smooth = 0.02 + 0.04 * (nm - 450.0) / 200.0;
      sum += (i == 0 || i == kSteps ? 1.0 : i % 2 ? 4.0 : 2.0) / 3.0 * 100.0 / kSteps * smooth * reflectance(nm) * response(nm);
    }
    const Frame f = renderFrame(sim);
    figure(std::string("a lamp of three lines upon a smooth part on a wall [W/(m2 sr)]") + (*accuracy ? ", 0.1 %" : ""), at(layer(f, "v.radiance"), f, 0, 0),
           sum / 100.0 / kPi, *accuracy ? 1e-3 : 2e-5, "sum of lines and integral over pi R^2");
  }
}

// Lines beyond a table's ends leave it as it is.
TEST(ClosedForms, LinesBeyondATable) {
  const auto lamp = [](const std::string& spectrum) {
    return scene("lights: [{name: l, position: [0 m, 0 m, 0 m], intensity: {wavelength: nm, unit: W/(sr nm), " + spectrum +
                 "}}]\ncameras: [{name: c, film: {width: 2, height: 2}, field_of_view: 1 deg, aperture: 5 mm, position: [9 m, 0 m, 0 m], look_at: [0 m, 1 m, 0 "
                 "m], channels: "
                 "[{name: v, response: {band: [0.5 um, 0.6 um]}}]}]\n")
        .lights[0]
        .intensity;
  };
  figure("intensity of a lamp of two lines beyond a flat part [W/sr]", lamp("values: [[400, 1], [700, 1]], lines: [[365, 10], [852, 4]]").integral(0.3, 0.9),
         314.0, 1e-6, "300 and the lines' own");
  try {
    (void)lamp("values: [[700, 1], [400, 1]], lines: [[500, 10]]");
    FAIL();
  } catch (const UserError& e) {
    EXPECT_NE(std::string(e.what()).find("do not rise"), std::string::npos) << e.what();
  }
}

// Everything at one temperature: whatever the materials, the picture is a black body's.
TEST(ClosedForms, IsothermalEnclosure) {
  const auto sim = scene(
      "ambient: {temperature: 350 K}\natmosphere: {extinction: 2 /km, temperature: 350 K}\n"
      "materials:\n  shiny: {components: [{reflection: phong, reflectance: 0.7, exponent: 200}, {reflection: lambertian, reflectance: 0.2, modifier: {rows: "
      "[[0, 1], [0.5, 0.2]]}}]}\n"
      "entities:\n  - {name: wall, shape: {model: sphere, radius: 40 m}, material: white_lambertian, temperature: 350 K}\n"
      "  - {name: a, shape: {model: sphere, radius: 1 m}, material: shiny, temperature: 350 K, position: [-6 m, 1 m, 0 m]}\n"
      "  - {name: b, shape: {model: cone, radius: 1 m, length: 3 m}, material: titanium, temperature: {rows: [[350 K]]}, position: [-7 m, -2 m, 0 m]}\n"
      "cameras:\n  - {name: c, film: {width: 64, height: 64}, field_of_view: 60 deg, aperture: 5 mm, position: [0 m, 0 m, 0 m], look_at: [-10 m, 0 m, 0 m], "
      "channels: [{name: lw, response: {band: [8 um, 12 um]}}]}\n");
  const Frame f = renderFrame(sim);
  double low = 1e30, high = 0.0;
  for (float v : layer(f, "lw.radiance").pixels) low = std::min(low, static_cast<double>(v)), high = std::max(high, static_cast<double>(v));
  figure("isothermal enclosure, darkest pixel [W/(m2 sr)]", low, blackBodyBand(8, 12, 350), 1e-5, "B(T), flat; single precision");
  figure("isothermal enclosure, brightest pixel [W/(m2 sr)]", high, blackBodyBand(8, 12, 350), 1e-5, "B(T), flat; single precision");
}

// The sky of a layer of air with a top, straight up: L_m (1 - exp(-gamma H)).
TEST(ClosedForms, SkyOfALayer) {
  const auto sim = scene(
      "atmosphere: {extinction: 0.2 /km, temperature: 280 K, top: 5 km}\n"
      "cameras:\n  - {name: c, film: {width: 33, height: 33}, field_of_view: 1 deg, aperture: 5 mm, position: [0 m, 0 m, 0 m], heading: 0 deg, pitch: 90 deg, "
      "channels: [{name: lw, response: {band: [8 um, 12 um]}}]}\n");
  const Frame f = renderFrame(sim);
  figure("zenith sky of a 5 km layer [W/(m2 sr)]", at(layer(f, "lw.radiance"), f, 16, 16), -blackBodyBand(8, 12, 280) * std::expm1(-1.0), 1e-5,
         "L_m (1 - exp(-gamma H))");
}

}  // namespace
}  // namespace pitviper::test
