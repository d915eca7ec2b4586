// Media that vary through their bodies, through the whole pipeline: radiance and intensity of puffs whose columns are known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/radiometry/constants.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/puff_scene.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string looking(double range_m, double field_deg, int pixels, const std::string& more = "") {
  return R"(
time: {frames: 1, rate: 1 Hz}
)" + more +
         R"(
cameras:
  - name: c
    film: {width: )" +
         std::to_string(pixels) + ", height: " + std::to_string(pixels) + R"(}
    field_of_view: )" +
         std::to_string(field_deg) + R"( deg
    aperture: 10 mm
    position: [)" +
         std::to_string(-range_m) + R"( m, 0 m, 2000 m]
    heading: 90 deg
    channels: [{name: mw, response: {band: [3 um, 5 um]}}]
)";
}

// Through the middle of a puff the column is M C int (1 - u^2)^3 du / R^2 = M 315/(64 pi) 32/35 / R^2, so L = B (1 - exp(-k times that)).
TEST(Fields, ThroughTheMiddleOfAPuff) {
  double worst = 0.0;
  for (double depth : {1e-4, 0.1, 1.0, 10.0}) {
    Simulation sim = scene(looking(100.0, 1.0, 9));
    constexpr double kRadius = 8.0, kAbsorption = 0.3, kKelvin = 700.0;
    const double middle = 315.0 / (64.0 * kPi) * 32.0 / 35.0 / (kRadius * kRadius);
    addPuffs(sim, {puffAt({0, 0, 2000}, kRadius, depth / (kAbsorption * middle), kKelvin)}, greyGas(kAbsorption));
    const Frame frame = renderFrame(sim);
    const double want = blackBodyBand(3.0, 5.0, kKelvin) * -std::expm1(-depth);
    worst = std::max(worst, std::abs(at(frame.layers.front(), frame, 4, 4) / want - 1.0));
  }
  bound("radiance through the middle of a puff, optical depths 1e-4 to 10", worst, 2e-4,
        "closed form of the kernel; single precision, quadrature in wavelength");
}

// A thin puff sends k M B in every direction, however many pixels it covers: no view of its own, and no edge.
TEST(Fields, IntensityAtAnyRange) {
  double worst = 0.0;
  for (double range : {100.0, 900.0, 7000.0, 60000.0, 500000.0}) {
    Simulation sim = scene(looking(range, 1.0, 33));
    constexpr double kAmount = 1e-3, kAbsorption = 0.02, kKelvin = 900.0;
    addPuffs(sim, {puffAt({0, 0.13 * range / 1000.0, 2000 + 0.21 * range / 1000.0}, 0.6, kAmount, kKelvin)}, greyGas(kAbsorption));
    const Frame frame = renderFrame(sim);
    double intensity = 0.0;
    for (int y = 0; y < 33; ++y)
      for (int x = 0; x < 33; ++x) intensity += at(frame.layers.front(), frame, x, y) * sim.cameras[0].pinhole.solidAngle_sr(x, y) * range * range;
    // 2e-5 of optical depth at most: 1 - exp(-d) is within 1e-5 of d.
    const double want = blackBodyBand(3.0, 5.0, kKelvin) * kAbsorption * kAmount;
    worst = std::max(worst, std::abs(intensity / want - 1.0));
  }
  bound("intensity of a thin puff of 1.2 m from 100 m to 500 km, worst", worst, 3e-3,
        "k M B; lines across a pixel lie a quarter of its support's radius apart at most");
}

// Sunlight scattered once by a thin puff: L = E albedo p(cos) k column.
TEST(Fields, SunlightScatteredOnce) {
  double worst = 0.0;
  for (double azimuth : {90.0, 150.0, 250.0}) {
    Simulation sim = scene(looking(100.0, 1.0, 9, "sun: {azimuth: " + std::to_string(azimuth) + " deg, elevation: 25 deg, temperature: 5772 K}"));
    constexpr double kRadius = 8.0, kAsymmetry = 0.6, kAlbedo = 0.8, kDepth = 1e-3;
    Medium smoke = greyGas(1.0);
    smoke.albedo = Spectrum(kAlbedo);
    smoke.asymmetry = Spectrum(kAsymmetry);
    const double middle = 315.0 / (64.0 * kPi) * 32.0 / 35.0 / (kRadius * kRadius);
    addPuffs(sim, {puffAt({0, 0, 2000}, kRadius, kDepth / middle, 10.0)}, smoke);
    const Frame frame = renderFrame(sim);
    const double cosine = std::sin(azimuth * kPi / 180) * std::cos(25 * kPi / 180), g = kAsymmetry;
    const double phase = (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
    const double irradiance = blackBodyBand(3.0, 5.0, 5772.0) * 6.7943e-5;
    const double want = irradiance * kAlbedo * phase * -std::expm1(-kDepth);
    worst = std::max(worst, std::abs(at(frame.layers.front(), frame, 4, 4) / want - 1.0));
  }
  bound("sunlight scattered once by thin smoke, three angles", worst, 1e-3, "E w p(cos) depth; solid angle of the sun to 5 digits, quadrature in wavelength");
}

// Puffs in each other, before and behind a wall, in air: the GPU's few steps against the reference's many.
TEST(Fields, GpuAgainstReference) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double worst = 0.0, worst99 = 0.0, covered = 0.0;
  for (int trial = 0; trial < 4; ++trial) {
    Simulation sim = scene(looking(60.0, 30.0, 48, R"(
atmosphere: {extinction: 2 /km, temperature: 285 K}
sun: {azimuth: 200 deg, elevation: 30 deg, temperature: 5772 K}
entities: [{name: wall, shape: {model: plate, width: 20 m, height: 14 m}, material: sand, temperature: 300 K, position: [4 m, 3 m, 2000 m], heading: 250 deg}]
accuracy: 1 %)"));
    std::vector<Puff> puffs;
    for (int k = 0; k < 30; ++k)
      puffs.push_back(puffAt({30 * unit(random) - 15, 24 * unit(random) - 12, 1990 + 20 * unit(random)}, 2.0 + 5.0 * unit(random), 20.0 * unit(random),
                             300.0 + 500.0 * unit(random)));
    Medium gas{Spectrum(Spectrum::Table{{2.5, 3.6, 4.2, 5.2}, {0.05, 0.3, 1.0, 0.1}, Outside::Hold, ""}), {}, {}, {}};
    if (trial % 2 == 1) {
      gas.albedo = Spectrum(0.5);
      gas.asymmetry = Spectrum(0.4);
    }
    addPuffs(sim, puffs, gas);
    const Worst w = compare(sim, 5);
    worst = std::max(worst, w.error);

    worst99 = std::max(worst99, w.percentile99);
    covered += w.covered;
  }
  EXPECT_GT(covered, 200);
  bound("30 puffs in each other at 300 to 800 K, 1 %: GPU against reference, worst pixel", worst, 1e-2, "the accuracy asked");
  bound("the same, 99 % of pixels", worst99, 1e-2, "the accuracy asked");
}

// Hot gas in cold gas at the same place, thin: L = d (a B(hot) + (1 - a) B(cold)), whatever the mean of their temperatures; their shares 1e-4 to a half.
TEST(Fields, HotInCold) {
  double worst = 0.0;
  for (double share : {1e-4, 0.01, 0.5}) {
    Simulation sim = scene(looking(100.0, 1.0, 9));
    constexpr double kRadius = 8.0, kDepth = 1e-3, kHot_K = 1400.0, kCold_K = 300.0;
    const double middle = 315.0 / (64.0 * kPi) * 32.0 / 35.0 / (kRadius * kRadius);
    addPuffs(sim, {puffAt({0, 0, 2000}, kRadius, kDepth * (1.0 - share) / middle, kCold_K), puffAt({0, 0, 2000}, kRadius, kDepth * share / middle, kHot_K)},
             greyGas(1.0));
    const Frame frame = renderFrame(sim);
    const double want = -std::expm1(-kDepth) * (share * blackBodyBand(3.0, 5.0, kHot_K) + (1.0 - share) * blackBodyBand(3.0, 5.0, kCold_K));
    worst = std::max(worst, std::abs(at(frame.layers.front(), frame, 4, 4) / want - 1.0));
  }
  bound("thin gas at 1400 K in gas at 300 K, a ten-thousandth to half of it", worst, 1e-3,
        "closed form; Planck's law between entries 2e-4, moments of temperature in single precision");
}

// Smoke far away in hazy air, with nothing in the scene that the sun lights: the air before it, the sun's way down to it, its own shade, lines that are close
// enough for its sharp edge. From the side, where the way through it is short compared with that to it, and along it.
TEST(Fields, FarSmokeInSunlitHaze) {
  for (const char* from : {"[-40 m, 1500 m, 20 m]", "[-5 m, 700 m, 20 m]"}) {
    const Simulation sim = scene(std::string(R"(
origin: {latitude: 40 deg, longitude: 15 deg}
time: {frames: 1, rate: 1 Hz}
atmosphere: {model: layered, library: hazy_us76, visibility: 8 km}
sun: {azimuth: 120 deg, elevation: 20 deg, irradiance: solar_e490}
wind: {speed: 4 m/s, direction: )") +
                                 (from[1] == '-' && from[2] == '4' ? "270" : "185") +
                                 R"( deg}
accuracy: 1 %
smokes: [{name: s, smoke: fog_oil, position: )" +
                                 from +
                                 R"(, rate: 1 kg/s, begin: -20 s, radius: 1 m, lifetime: 60 s, puffs: 30}]
cameras:
  - name: c
    film: {width: 16, height: 8}
    field_of_view: 4.5 deg
    aperture: 10 mm
    samples: 1
    position: [0 m, 0 m, 10 m]
    heading: 0 deg
    pitch: 0.7 deg
    channels:
      - {name: near, response: {band: [2.1 um, 2.3 um]}}
      - {name: mw, response: {band: [3.6 um, 4.9 um]}}
)");
    const Worst w = compare(sim, 2);
    EXPECT_GT(w.covered, 25);
    bound(std::string("smoke in sunlit haze, ") + (from[2] == '4' ? "across" : "along") + ", 1 %: GPU against reference, worst pixel", w.error, 1e-2,
          "the accuracy asked");
  }
}

}  // namespace
}  // namespace pitviper::test
