// What a lens does besides spreading points: distortion, vignetting, its own light, its F number.
#include <gtest/gtest.h>

#include <cmath>

#include "sensors/figures.hpp"
#include "sim/model/stage.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// 64 x 48 pixels over 64 x 0.01 in tangents: a wide camera.
std::string wide(const std::string& rest, const std::string& channel = "{name: mw, response: {band: [3.6 um, 4.9 um]}, output: [radiance, flux]}") {
  return "cameras: [{name: c, film: {width: 64, height: 48, pitch: 20 um}, focal_length: 2 mm, aperture: 1 mm, exposure: 1 ms, position: [0 m, 0 m, 0 m], "
         "heading: 90 deg, " +
         rest + ", channels: [" + channel + "]}]\n";
}

std::string refusalOf(const std::string& yaml) {
  try {
    (void)scene(yaml);
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

// Lamps through Brown's law: the middle of their light on the film against the law itself.
TEST(Lens, DistortionMovesLampsAsBrownSays) {
  const double k1 = -0.25, k2 = 0.08, p1 = 0.01, p2 = -0.02;
  for (const auto& [x, y] : {std::pair{0.12, 0.05}, std::pair{-0.2, 0.15}, std::pair{0.22, -0.17}}) {
    // The camera looks east: right is south, down is -z.
    const Frame f = renderFrame(scene(
        "background: {temperature: 3 K}\nlights: [{name: l, intensity: {wavelength: um, unit: W/(sr um), values: [[3, 100], [5, 100]]}, position: [1000 m, " +
        std::to_string(-1000.0 * x) + " m, " + std::to_string(-1000.0 * y) + " m]}]\n" +
        wide(print("stages: [{stage: distortion, k1: %g, k2: %g, p1: %g, p2: %g}, {stage: point_spread, diffraction: false, blur: 20 um, beyond: 1e-4}]", k1,
                   k2, p1, p2))));
    double sum = 0.0, column = 0.0, row = 0.0;
    const FrameLayer& flux = layer(f, "mw.flux");
    for (int r = 0; r < 48; ++r)
      for (int c = 0; c < 64; ++c) {
        const double v = at(flux, f, c, r);
        sum += v, column += v * (c + 0.5), row += v * (r + 0.5);
      }
    const double r2 = x * x + y * y, radial = 1.0 + k1 * r2 + k2 * r2 * r2;
    const double xd = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x), yd = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
    bound(print("a lamp at (%g, %g) through a distorting lens, columns off Brown's law", x, y), std::abs(column / sum - (32.0 + xd * 100.0)), 2e-3,
          "veil of 1e-4, and single precision");
    bound("the same, rows off", std::abs(row / sum - (24.0 + yd * 100.0)), 2e-3, "veil of 1e-4, and single precision");
  }
}

// An even field keeps its radiance through a distorting lens; its flux goes with the area that a pixel sees: d Omega cos = cos^4 dx dy of the undistorted
// place.
TEST(Lens, DistortionKeepsRadianceAndCountsArea) {
  const double k1 = -0.3;
  const Frame f = renderFrame(scene("background: {temperature: 300 K}\n" + wide(print("stages: [{stage: distortion, k1: %g}]", k1))));
  const double radiance = blackBodyBand(3.6, 4.9, 300.0);
  double worst = 0.0, worstFlux = 0.0;
  for (int r = 0; r < 48; ++r)
    for (int c = 0; c < 64; ++c) {
      worst = std::max(worst, std::abs(at(layer(f, "mw.radiance"), f, c, r) / radiance - 1.0));
      const double rd = std::hypot((c - 31.5) * 0.01, (r - 23.5) * 0.01);
      double ru = rd;  // Newton on r (1 + k1 r^2)
      for (int k = 0; k < 50; ++k) ru -= (ru * (1.0 + k1 * ru * ru) - rd) / (1.0 + 3.0 * k1 * ru * ru);
      const double area = rd > 0.0 ? ru / rd / (1.0 + 3.0 * k1 * ru * ru) : 1.0;  // ru dru / (rd drd)
      const double flux = radiance * 0.25 * kPi * 1e-6 * 1e-4 * area / std::pow(1.0 + ru * ru, 2.0);
      worstFlux = std::max(worstFlux, std::abs(at(layer(f, "mw.flux"), f, c, r) / flux - 1.0));
    }
  bound("radiance of an even field through a distorting lens", worst, 1e-5, "single precision");
  bound("flux of its pixels against the area they see", worstFlux, 2e-3, "a pixel's middle for its mean: (0.01)^2 of curvature; cubic between cells");
}

// Edges stay between what is on their two sides.
TEST(Lens, DistortionDoesNotRing) {
  const Frame f =
      renderFrame(scene("background: {temperature: 3 K}\nmaterials: {m: {components: []}}\nentities: [{name: p, shape: {model: plate, width: 300 m, height: "
                        "300 m}, material: m, temperature: "
                        "400 K, position: [1000 m, 0 m, 0 m]}]\n" +
                        wide("samples: 4, stages: [{stage: distortion, k1: 0.2}]")));
  const double whole = blackBodyBand(3.6, 4.9, 400.0);
  for (float v : layer(f, "mw.radiance").pixels) {
    ASSERT_GE(v, 0.0f);
    ASSERT_LE(static_cast<double>(v), whole * (1.0 + 1e-5));
  }
}

TEST(Lens, Vignetting) {
  const Frame f = renderFrame(scene("background: {temperature: 300 K}\n" + wide("stages: [{stage: vignetting, v1: -2, v2: 1}]"))),
              plain = renderFrame(scene("background: {temperature: 300 K}\n" + wide("truth: [range]")));
  double worst = 0.0;
  for (int r = 0; r < 48; ++r)
    for (int c = 0; c < 64; ++c) {
      const double tan2 = std::pow((c - 31.5) * 0.01, 2.0) + std::pow((r - 23.5) * 0.01, 2.0);
      worst = std::max(worst, std::abs(at(layer(f, "mw.flux"), f, c, r) / at(layer(plain, "mw.flux"), plain, c, r) / (1.0 - 2.0 * tan2 + tan2 * tan2) - 1.0));
      EXPECT_NEAR(at(layer(f, "mw.radiance"), f, c, r) / at(layer(plain, "mw.radiance"), plain, c, r), 1.0, 1e-6);
    }
  bound("vignetting of each pixel against its polynomial", worst, 1e-6, "single precision");
  const Frame oblong =
      renderFrame(scene("background: {temperature: 300 K}\ncameras: [{name: c, film: {width: 33, height: 33, pitch: 20 um, pitch_y: 10 um}, focal_length: 1 "
                        "mm, aperture: 0.5 mm, position: [0 m, 0 m, 0 m], heading: 0 deg, "
                        "stages: [{stage: vignetting, v1: -1}], channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}, output: flux}]}]\n"));
  figure("vignetting of the top middle pixel of half height", at(layer(oblong, "mw.flux"), oblong, 16, 0) / at(layer(oblong, "mw.flux"), oblong, 16, 16),
         (1.0 - 0.16 * 0.16) / std::pow(1.0 + 0.16 * 0.16, 2.0), 1e-4, "1 - tan^2, cos^4");
}

// A film in a cold dewar behind a warm lens: pi / (4 F^2) of what the lens sends, and what the housing sends around it as far as the stop is open.
TEST(Lens, ItsOwnLight) {
  const auto electrons = [](const std::string& stage) {
    const Frame f =
        renderFrame(scene("background: {temperature: 3 K}\ncameras: [{name: c, film: {width: 16, height: 16, pitch: 15 um}, focal_length: 100 mm, f_number: 4, "
                          "optics: 0.85, exposure: 2 ms, "
                          "position: [0 m, 0 m, 0 m], heading: 0 deg, stages: [" +
                          stage + "], channels: [{name: lw, response: {band: [8 um, 9 um]}, quantum_efficiency: 0.6, output: [electrons, flux]}]}]\n"));
    return at(layer(f, "lw.electrons"), f, 8, 8);
  };
  double photons = 0.0;  // radiance of a black body of 300 K in photons
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const double w = 8.0 + 1.0 * (i + 0.5) / kSteps;
    photons += 1.0 / kSteps * (blackBodyBand(w - 1e-4, w + 1e-4, 300.0) / 2e-4) * w * 1e-6 / (6.62607015e-34 * 299792458.0);
  }
  const double cone = kPi / (4.0 * 16.0) * 15e-6 * 15e-6 * 2e-3 * 0.6 * photons;
  figure("electrons of a lens of 300 K that takes 15 % of the light", electrons("{stage: lens_emission, temperature: 300 K}"), 0.15 * cone, 1e-4,
         "e B A pi / (4 F^2) QE t");
  figure("with a cold stop of F/2 and a housing as warm", electrons("{stage: lens_emission, temperature: 300 K, stop_f_number: 2}"), (0.15 + 3.0) * cone, 1e-4,
         "(F / F_stop)^2 - 1 = 3 around it");
  figure("without a stop, of an emissivity of 0.9",
         electrons("{stage: lens_emission, temperature: 300 K, emissivity: 0.05, stop_f_number: 0.5, housing_emissivity: 0.9}"), (0.05 + 63.0 * 0.9) * cone,
         1e-4, "4 F^2 - 1 = 63");
  EXPECT_NE(refusalOf("cameras: [{name: c, film: {width: 4, height: 4, pitch: 15 um}, focal_length: 100 mm, f_number: 2, position: [0 m, 0 m, 0 m], heading: 0 "
                      "deg, stages: "
                      "[{stage: lens_emission, temperature: 300 K, stop_f_number: 3}], channels: [{name: m, response: {band: [3 um, 5 um]}}]}]\n")
                .find("cuts into the lens's cone"),
            std::string::npos);
}

// A calibration takes the lens's light away: a black body looks as warm as it is.
TEST(Lens, ApparentTemperatureKnowsTheLens) {
  const Frame f =
      renderFrame(scene("background: {temperature: 310 K}\ncameras: [{name: c, film: {width: 32, height: 32, pitch: 15 um}, focal_length: 100 mm, f_number: 2, "
                        "optics: 0.8, exposure: 0.2 ms, "
                        "position: [0 m, 0 m, 0 m], heading: 0 deg, stages: [{stage: lens_emission, temperature: 330 K, stop_f_number: 1.5}, {stage: detector, "
                        "full_well: 1e8, bits: 16}], "
                        "channels: [{name: lw, response: {band: [8 um, 9 um]}, quantum_efficiency: 0.6, output: [apparent_temperature, counts]}]}]\n"));
  double mean = 0.0;
  for (float v : layer(f, "lw.apparent_temperature").pixels) mean += static_cast<double>(v) / 1024.0;
  figure("apparent temperature of a black body of 310 K behind a lens of 330 K", mean, 310.0, 2e-4, "shot noise over the root of 1024 pixels");
}

// The same over a wide film, behind whatever takes light away and adds to it off the axis.
TEST(Lens, ApparentTemperatureOverTheFilm) {
  for (const char* stages :
       {"{stage: distortion, k1: -0.3}", "{stage: vignetting, v1: -1}", "{stage: lens_emission, temperature: 300 K, emissivity: 0.3, stop_f_number: 1}",
        "{stage: distortion, k1: -0.2}, {stage: point_spread, diffraction: false, blur: 20 um}, {stage: vignetting, v1: -0.5}, {stage: lens_emission, "
        "temperature: 320 K, emissivity: 0.1}"}) {
    const Frame f = renderFrame(scene("background: {temperature: 300 K}\n" +
                                      wide(std::string("stages: [") + stages + ", {stage: detector, full_well: 2e9, bits: 16}]",
                                           "{name: lw, response: {band: [8 um, 9 um]}, quantum_efficiency: 0.6, output: [apparent_temperature]}")));
    double worst = 0.0;
    for (float v : layer(f, "lw.apparent_temperature").pixels) worst = std::max(worst, std::abs(static_cast<double>(v) - 300.0));
    bound(std::string("apparent temperature of a black body of 300 K off over the film [K], ") + stages, worst, 0.2,
          "shot noise and steps of a count, the worst of 3072 pixels; without the calibration up to 16 K");
  }
}

// A lens that zooms: the housing has what the cone leaves of the stop, at every focal length.
TEST(Lens, ItsHousingFollowsTheZoom) {
  const auto flux = [](const std::string& focal, const std::string& commands) {
    const Frame f =
        renderFrame(scene("background: {temperature: 3 K}\ncameras: [{name: c, film: {width: 16, height: 16, pitch: 15 um}, focal_length: " + focal +
                          ", aperture: 25 mm, position: [0 m, 0 m, 0 m], heading: 0 deg, stages: [{stage: lens_emission, temperature: 300 K, emissivity: 0, "
                          "stop_f_number: 1}], channels: [{name: lw, "
                          "response: {band: [8 um, 9 um]}, output: focal_irradiance}]}]\n" +
                          commands));
    return at(layer(f, "lw.focal_irradiance"), f, 8, 8);
  };
  const double angle = 2.0 * std::atan(0.5 * 16 * 15e-6 / 0.15);
  const double zoomed = flux("100 mm", print("commands: [{command: look, at: 0 s, camera: c, field_of_view: %.12g rad}]\n", angle)), own = flux("150 mm", "");
  figure("irradiance of a housing at F/6 after a zoom from F/4 [W/m2]", zoomed, own, 1e-5, "the same lens");
  figure("the same by its cone [W/m2]", own, 0.25 * kPi * blackBodyBand(8, 9, 300) * (1.0 - 1.0 / 36.0), 1e-4, "pi B / 4 (1 / F_stop^2 - 1 / F^2)");
}

TEST(Lens, FNumberFocalLengthAndAperture) {
  const auto camera = [](const std::string& keys) {
    return "cameras: [{name: c, film: {width: 4, height: 4, pitch: 15 um}, " + keys +
           ", position: [0 m, 0 m, 0 m], heading: 0 deg, channels: [{name: m, response: {band: [3 um, 5 um]}}]}]\n";
  };
  EXPECT_NEAR(scene(camera("focal_length: 100 mm, f_number: 4")).cameras[0].pinhole.apertureDiameter_m, 0.025, 1e-15);
  EXPECT_NEAR(scene(camera("focal_length: 100 mm, aperture: 25 mm, f_number: 4")).cameras[0].pinhole.apertureDiameter_m, 0.025, 1e-15);
  EXPECT_NE(refusalOf(camera("focal_length: 100 mm, aperture: 25 mm, f_number: 2")).find("three that agree"), std::string::npos);
  EXPECT_NE(refusalOf(camera("focal_length: 100 mm")).find("without an aperture"), std::string::npos);
  EXPECT_NE(refusalOf(wide("stages: [{stage: distortion, k1: -3}]")).find("distortion that"), std::string::npos);
}

}  // namespace
}  // namespace pitviper::test
