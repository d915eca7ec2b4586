// Lines of sight that meet no body and go down end at the earth's sphere, in every mode.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/parameters/error.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0;
const char* kModes[] = {"accuracy: 1 %\nrender: {mode: direct}\n", "accuracy: 1 %\nrender: {mode: buffered}\n", "accuracy: reference\n"};

std::string camera(double height_m, double pitch_deg, int pixels, double field_deg, const std::string& more) {
  return "cameras:\n  - name: c\n    film: {width: " + std::to_string(pixels) + ", height: " + std::to_string(pixels) +
         "}\n    field_of_view: " + print("%.9g", field_deg) + " deg\n    aperture: 5 mm\n    position: [0 m, 0 m, " + print("%.9g", height_m) +
         " m]\n    heading: 30 deg\n    pitch: " + print("%.9g", pitch_deg) + " deg\n" + more;
}

const std::string kLongWave = "    channels: [{name: lw, response: {band: [8 um, 12 um]}}]\n";

/// To the sphere in long double.
double rangeDown(double height_m, double pitch_deg) {
  const long double r = LocalFrame().earthRadius_m(), h = height_m, b = (r + h) * std::sin(static_cast<long double>(pitch_deg) * kDegree), c = h * (2 * r + h);
  return static_cast<double>(-b - std::sqrt(b * b - c));
}

TEST(Ground, LiesUnderLayeredAir) {
  for (const char* mode : kModes) {
    double before = 0.0;
    for (double pitch : {-90.0, -45.0, -10.0, -5.0, -2.0}) {
      const Simulation sim = scene(std::string(mode) + "atmosphere: clear_us76\nbackground: {temperature: 3 K}\n" +
                                   camera(1000.0, pitch, 1, 0.01, "    truth: [range, temperature]\n" + kLongWave));
      const Frame frame = renderFrame(sim);
      const double seen = at(layer(frame, "lw.radiance"), frame, 0, 0);
      EXPECT_LT(seen, blackBodyBand(8, 12, 288.2)) << mode << pitch;
      EXPECT_GT(seen, blackBodyBand(8, 12, 281.7)) << mode << pitch;
      EXPECT_TRUE(before == 0.0 || seen < before) << mode << pitch;  // the more air, the colder
      before = seen;
      EXPECT_NEAR(at(layer(frame, "truth.range"), frame, 0, 0) / rangeDown(1000.0, pitch), 1.0, 1e-4) << mode << pitch;
      EXPECT_NEAR(at(layer(frame, "truth.temperature"), frame, 0, 0), 288.2, 1e-3);
    }
  }
}

TEST(Ground, IsothermalWorldWithoutBodiesIsBlackAllAround) {
  for (const char* mode : kModes)
    for (double height : {2.0, 1500.0, 12000.0}) {
      const Simulation sim =
          scene(std::string(mode) + "atmosphere: {library: hazy_us76, temperature: 280 K}\nbackground: {temperature: 280 K}\n" +
                camera(height, -2.0, 24, 60.0, "    channels: [{name: mw, response: {band: [3 um, 5 um]}}, {name: lw, response: {band: [8 um, 12 um]}}]\n"));
      const Frame frame = renderFrame(sim);
      double worst = 0.0;
      for (size_t c = 0; c < 2; ++c)
        for (float v : frame.layers[c].pixels)
          worst = std::max(worst, std::abs(static_cast<double>(v) / (c == 0 ? blackBodyBand(3, 5, 280) : blackBodyBand(8, 12, 280)) - 1.0));
      bound("isothermal air over a ground of its temperature, 60 deg across the horizon from " + print("%g", height) + " m, off Planck's law", worst, 1e-4,
            "single precision; bins of 5 1/cm in double");
    }
}

// Across the horizon by a hundredth of a degree: the planned picture is the reference's, and nothing jumps but what the air lets through.
TEST(Ground, HorizonHasNoSeam) {
  for (const char* air : {"clear_us76", "hazy_us76"})
    for (double height : {20.0, 1000.0}) {
      const double dip = std::acos(LocalFrame().earthRadius_m() / (LocalFrame().earthRadius_m() + height)) / kDegree;
      const auto picture = [&](const char* mode) {
        // Two columns of 24 pixels: along it a horizon is the same.
        std::string eye = camera(height, -dip, 2, 1.0 / 12.0,
                                 "    channels: [{name: lw, response: {band: [8 um, 12 um]}}, {name: mw, response: {band: [4.4 um, 4.8 um]}}]\n");
        eye.replace(eye.find("height: 2}"), 10, "height: 24}");
        return renderFrame(scene(std::string(mode) + "atmosphere: " + air + "\nsun: {azimuth: 210 deg, elevation: 40 deg, temperature: 5772 K}\n" + eye));
      };
      const Frame reference = picture(kModes[2]);
      for (const char* mode : {kModes[0], kModes[1]}) {
        const Frame planned = picture(mode);
        double worst = 0.0;
        for (size_t c = 0; c < 2; ++c)
          for (size_t p = 0; p < planned.layers[c].pixels.size(); ++p)
            worst = std::max(worst, std::abs(static_cast<double>(planned.layers[c].pixels[p] / reference.layers[c].pixels[p]) - 1.0));
        bound(std::string("horizon of ") + air + " from " + print("%g", height) + " m, 0.04 deg a pixel, planned at 1 % against double", worst, 1e-2,
              "what was asked");
      }
      // From the ground's last row to the sky's first the long wave changes by no more than the horizon's transmittance lets show.
      double jump = 0.0;
      for (int row = 0; row + 1 < 24; ++row)
        jump = std::max(jump, std::abs(at(reference.layers[0], reference, 1, row) / at(reference.layers[0], reference, 1, row + 1) - 1.0));
      bound(std::string("largest step between rows about that horizon, ") + air, jump, 0.05, "air of the horizon's range is nearly black in 8-12 um");
    }
}

TEST(Ground, IsWhatTheScenarioSays) {
  // Air of one extinction: as before without a ground, Beer-Lambert to the sphere with one.
  const std::string air = "atmosphere: {extinction: 0.1 /km, temperature: 250 K}\nbackground: {temperature: 0 K}\n",
                    eye = camera(3000.0, -30.0, 1, 0.01, kLongWave);
  const double tau = std::exp(-1e-4 * rangeDown(3000.0, -30.0)), cold = blackBodyBand(8, 12, 250);
  figure("endless air without a ground, looking down", static_cast<double>(renderFrame(scene(air + eye)).layers[0].pixels[0]), cold, 1e-5, "B(250 K)");
  for (const char* mode : {"", "render: {mode: buffered}\n", "accuracy: reference\n"}) {
    figure("the same with a ground of 300 K", static_cast<double>(renderFrame(scene(mode + air + "ground: {temperature: 300 K}\n" + eye)).layers[0].pixels[0]),
           tau * blackBodyBand(8, 12, 300) + (1.0 - tau) * cold, 2e-5, "B(300 K) tau + B(250 K) (1 - tau) to the sphere");
    figure("the same with a ground of the air's temperature", static_cast<double>(renderFrame(scene(mode + air + "ground: {}\n" + eye)).layers[0].pixels[0]),
           cold, 1e-5, "B(250 K)");
    // Lit by the sun and a dome; a lamp does not light it. On the far side of the earth's bulge its normal is not the camera's vertical.
    const double down = rangeDown(3000.0, -30.0), e = 50.0 * kDegree, radius = LocalFrame().earthRadius_m();
    const double along = down * std::cos(30.0 * kDegree), turn = std::asin(along / radius);
    const double lit =
        (0.4 / kPi * 100.0 * 4.0 * std::sin(e + turn) + 0.4 * blackBodyBand(8, 12, 270) + 0.6 * blackBodyBand(8, 12, 300)) * tau + (1.0 - tau) * cold;
    figure("a grey ground in sunlight under a dome",
           static_cast<double>(renderFrame(scene(mode + air +
                                                 "ground: {temperature: 300 K, material: {components: [{reflection: lambertian, reflectance: 0.4}]}}\n"
                                                 "sun: {azimuth: 30 deg, elevation: 50 deg, irradiance: 100 W/(m2 um)}\nambient: {temperature: 270 K}\n"
                                                 "lights: [{name: l, intensity: 1e9 W/(sr um), position: [0 m, 0 m, 1 km], visible: false}]\n" +
                                                 eye))
                                   .layers[0]
                                   .pixels[0]),
           lit, 5e-5, "rho E sin(e) / pi + rho B(270 K) + (1 - rho) B(300 K), through the air");
  }
}

TEST(Ground, BodiesAreSeenBeforeIt) {
  for (const char* mode : kModes) {
    const Frame frame = renderFrame(
        scene(std::string(mode) + "atmosphere: clear_us76\n" +
              "entities: [{name: pit, shape: {model: plate, width: 4 m, height: 4 m}, material: blackbody, temperature: 330 K, position: [0 m, 0 m, -30 m], "
              "pitch: 90 deg}]\n" +
              camera(100.0, -90.0, 9, 10.0, "    truth: [range, entity]\n" + kLongWave)));
    EXPECT_NEAR(at(layer(frame, "truth.range"), frame, 4, 4), 130.0, 0.05) << mode;  // below the sphere, and still seen; over the pixel
    EXPECT_GT(at(layer(frame, "lw.radiance"), frame, 4, 4), blackBodyBand(8, 12, 320)) << mode;
    EXPECT_EQ(at(layer(frame, "truth.entity"), frame, 0, 0), 0.0) << mode;
    EXPECT_NEAR(at(layer(frame, "truth.range"), frame, 4, 0), 100.0 / std::cos(std::atan(8.0 / 9.0 * std::tan(5.0 * kDegree))), 1e-2) << mode;
  }
}

TEST(Ground, MistakesAreRefused) {
  const std::string eye = camera(10.0, 0.0, 1, 1.0, kLongWave);
  for (const auto& [text, wrong] : {std::pair<const char*, const char*>{"ground: {}\n", "without a temperature"},
                                    {"ground: {temperature: 280 K, material: {transmission: {transmittance: 0.5}}}\n", "transparent"},
                                    {"ground: {temperature: 280 K, colour: green}\n", "colour"}}) {
    try {
      scene(text + eye);
      ADD_FAILURE() << text;
    } catch (const UserError& e) {
      EXPECT_NE(std::string(e.what()).find(wrong), std::string::npos) << e.what();
    }
  }
}

// A lamp beyond the bulge of the earth is hidden by it; one before it, or standing on a body, is not.
TEST(Ground, HidesLamps) {
  const auto brightest = [](const char* mode, double z_m, const std::string& more) {
    const Frame f =
        renderFrame(scene(std::string(mode) + "ground: {temperature: 290 K}\nlights: [{name: la, intensity: 1e9 W/(sr um), position: [0 m, 100 km, " +
                          print("%.9g", z_m) + " m]}]\n" + more +
                          "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 1 deg, aperture: 5 mm, position: [0 m, 0 m, 100 m], look_at: [0 m, "
                          "100 km, " +
                          print("%.9g", z_m) + " m], channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n"));
    const auto& p = layer(f, "lw.radiance").pixels;
    return static_cast<double>(*std::max_element(p.begin(), p.end()));
  };
  for (const char* mode : {"", "accuracy: 1 %\n", "accuracy: reference\n"}) {
    // 100 km off the sphere lies 784 m below the level plane; from 100 m up it hides what is more than some 325 m below that.
    EXPECT_LT(brightest(mode, -770.0, ""), 100.0) << mode;
    EXPECT_GT(brightest(mode, 100.0, ""), 1e4) << mode;
    EXPECT_GT(
        brightest(mode, -770.0,
                  "materials: {m: {components: [{reflection: lambertian, reflectance: 0.1}]}}\nentities: [{name: wall, shape: {model: plate, width: 9 km, "
                  "height: 9 km}, material: m, temperature: 290 K, heading: 180 deg, position: [0 m, 101 km, -770 m]}]\n"),
        1e4)
        << mode << "a body is seen before the ground, and so is what stands before it";
  }
}

// `near` is a depth, not a distance: off the axis what is nearer by depth is cut away and hides no lamp, though it is farther away than `near`.
TEST(Near, HidesNoLampsByDepth) {
  const auto brightest = [](const char* mode, double depth_m) {
    // A pane of wall across the line to a lamp 45 degrees off the axis.
    const std::string wall =
        "materials: {m: {components: [{reflection: lambertian, reflectance: 0.1}]}}\nentities: [{name: wall, shape: {model: plate, width: 20 cm, height: "
        "20 cm}, material: m, temperature: 20 K, heading: 180 deg, position: [" +
        print("%.9g m, %.9g m, 0 m", depth_m, depth_m) + "]}]\n";
    const Frame f =
        renderFrame(scene(std::string(mode) + wall +
                          "lights: [{name: la, intensity: 1 W/(sr um), position: [10 m, 10 m, 0 m]}]\n"
                          "cameras: [{name: c, film: {width: 33, height: 33}, field_of_view: 110 deg, aperture: 5 mm, near: 1 m, look_at: [0 m, 1 m, 0 m], "
                          "position: [0 m, 0 m, 0 m], channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n"));
    const auto& p = layer(f, "lw.radiance").pixels;
    return static_cast<double>(*std::max_element(p.begin(), p.end()));
  };
  for (const char* mode : {"", "accuracy: reference\n"}) {
    const double open = brightest(mode, -5.0), cut = brightest(mode, 0.85), hidden = brightest(mode, 1.15);
    EXPECT_GT(open, 0.0);
    EXPECT_NEAR(cut / open, 1.0, 1e-6) << mode;
    EXPECT_LT(hidden, 0.5 * open) << mode;
  }
}

}  // namespace
}  // namespace pitviper::test
