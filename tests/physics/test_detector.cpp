// Counts of a flat field against what the detector's figures say they must be.
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

constexpr int kSide = 64;

/// A film that a black body of 300 K fills, seen in 3.5 to 4.9 um with a quantum efficiency of 0.8 through F/4.
Simulation field(const std::string& detector, const std::string& output = "counts", double kelvin = 300.0, const std::string& more = "") {
  return scene(
      "seed: 11\nbackground: {temperature: " + std::to_string(kelvin) + " K}\n" + more +
      "cameras: [{name: c, film: {width: 64, height: 64, pitch: 15 um}, focal_length: 100 mm, aperture: 25 mm, exposure: 4 ms, position: [0 m, 0 m, 0 m], "
      "heading: 0 deg, stages: [{stage: detector, " +
      detector + "}], channels: [{name: mw, response: {band: [3.5 um, 4.9 um]}, quantum_efficiency: 0.8, output: [electrons, " + output + "]}]}]\n");
}

struct Moments {
  double mean = 0.0, variance = 0.0;
};
Moments momentsOf(const std::vector<double>& x) {
  Moments m;
  for (double v : x) m.mean += v / static_cast<double>(x.size());
  for (double v : x) m.variance += (v - m.mean) * (v - m.mean) / static_cast<double>(x.size() - 1);
  return m;
}
std::vector<double> pixels(const Frame& f, const char* name) {
  const auto& p = layer(f, name).pixels;
  return {p.begin(), p.end()};
}

// EMVA 1288: variance over mean is the gain, for light and dark current; read noise and rounding besides.
TEST(Detector, PhotonTransfer) {
  const std::string law = "full_well: 7e6, bits: 16, gain: 0.05, offset: 100, read_noise: 400, dark_current: 2e7 /s";
  for (double kelvin : {250.0, 280.0, 300.0}) {
    const Frame f = renderFrame(field(law, "counts", kelvin));
    const double electrons = momentsOf(pixels(f, "mw.electrons")).mean, dark = 2e7 * 4e-3;
    const Moments counts = momentsOf(pixels(f, "mw.counts"));
    const double variance = 0.0025 * (electrons + dark + 160000.0) + 1.0 / 12.0, n = kSide * kSide;
    figure(print("mean count at %g K", kelvin), counts.mean, 100.0 + 0.05 * (electrons + dark), 4.0 * std::sqrt(variance / n) / counts.mean,
           "gain (e + dark) + offset; 4 standard errors");
    figure(print("variance of counts at %g K", kelvin), counts.variance, variance, 4.0 * std::sqrt(2.0 / n),
           "gain^2 (e + dark + sigma^2) + 1/12; 4 standard errors");
  }
}

// Photoelectrons by the closed form: pi L A tau / (4 F^2) at the middle, over photon energies.
TEST(Detector, ElectronsByClosedForm) {
  const Frame f = renderFrame(field("full_well: 1e9"));
  double photons = 0.0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const double w = 3.5 + 1.4 * (i + 0.5) / kSteps;
    photons += 1.4 / kSteps * (blackBodyBand(w - 1e-4, w + 1e-4, 300.0) / 2e-4) * w * 1e-6 / (6.62607015e-34 * 299792458.0);
  }
  figure("photoelectrons of the middle pixel", at(layer(f, "mw.electrons"), f, 32, 32),
         0.8 * photons * kPi * 0.25 * 0.025 * 0.025 * std::pow(15e-6 / 0.1, 2.0) * 4e-3, 2e-5, "QE t L_p A Omega");
}

// Each component of the three-dimensional model, of 64 frames: averages over the others leave it.
TEST(Detector, NoiseComponents) {
  const Simulation sim = field(
      "full_well: 1e7, bits: 16, gain: 0.5, offset: 3000, read_noise: 90, row_noise: 60, column_noise: 50, frame_noise: 40, dsnu: 80, fixed_row_noise: 70, "
      "fixed_column_noise: 45",
      "counts", 20.0, "time: {rate: 60 Hz, frames: 64}\n");
  constexpr int kFrames = 64;
  std::vector<std::vector<double>> cube;
  for (int t = 0; t < kFrames; ++t) cube.push_back(pixels(renderFrame(sim, t), "mw.counts"));
  const auto mean = [&](bool t, bool v, bool h) {
    // Means over what is not kept, of what is: [t][v][h], one entry where it is not.
    const int nt = t ? kFrames : 1, nv = v ? kSide : 1, nh = h ? kSide : 1;
    std::vector<double> all(static_cast<size_t>(nt * nv * nh), 0.0);
    for (int i = 0; i < kFrames; ++i)
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
          all[static_cast<size_t>(((t ? i : 0) * nv + (v ? y : 0)) * nh + (h ? x : 0))] +=
              cube[static_cast<size_t>(i)][static_cast<size_t>(y * kSide + x)] / 0.5;
    for (double& a : all) a *= static_cast<double>(nt * nv * nh) / (kFrames * kSide * kSide);
    return all;
  };
  const auto variance = [&](bool t, bool v, bool h) { return momentsOf(mean(t, v, h)).variance; };
  // Of a mean's variance what the finer components leave in it.
  const double n = kSide, rounding = 1.0 / (12.0 * 0.25), tvh = 8100.0 + rounding, tv = 3600.0, th = 2500.0, st = 1600.0, vh = 6400.0, v = 4900.0, h = 2025.0;
  const auto check = [](const char* what, double found, double expected, double degrees) {
    figure(what, found, expected, 4.0 * std::sqrt(2.0 / degrees), "4 standard errors");
  };
  check("variance over frames of the frame's mean", variance(true, false, false), st + tv / n + th / n + tvh / (n * n), 63.0);
  check("variance over rows of a row's mean", variance(false, true, false), v + vh / n + tv / n + tvh / (n * n), 63.0);
  check("variance over columns of a column's mean", variance(false, false, true), h + vh / n + th / n + tvh / (n * n), 63.0);
  // Two-dimensional means less their one-dimensional ones.
  const auto residue = [&](bool t, bool rows, bool columns) {
    const auto two = mean(t, rows, columns);
    const int nt = t ? kFrames : 1, nv = rows ? kSide : 1, nh = columns ? kSide : 1;
    const auto ofT = mean(t, false, false), ofV = mean(false, rows, false), ofH = mean(false, false, columns);
    const double whole = momentsOf(two).mean;
    double sum = 0.0;
    for (int i = 0; i < nt; ++i)
      for (int y = 0; y < nv; ++y)
        for (int x = 0; x < nh; ++x) {
          const double off = two[static_cast<size_t>((i * nv + y) * nh + x)] - (t ? ofT[static_cast<size_t>(i)] : whole) -
                             (rows ? ofV[static_cast<size_t>(y)] : whole) - (columns ? ofH[static_cast<size_t>(x)] : whole) + 2.0 * whole;
          sum += off * off;
        }
    return sum / (63.0 * 63.0);
  };
  check("of frames and rows", residue(true, true, false), tv + tvh / n, 63.0 * 63.0);
  check("of frames and columns", residue(true, false, true), th + tvh / n, 63.0 * 63.0);
  check("of rows and columns", residue(false, true, true), vh + tvh / n, 63.0 * 63.0);
  double sum = 0.0;
  const auto rc = mean(false, true, true), fr = mean(true, true, false), fc = mean(true, false, true), f = mean(true, false, false),
             r = mean(false, true, false), c = mean(false, false, true);
  const double whole = momentsOf(f).mean;
  for (int i = 0; i < kFrames; ++i)
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const auto I = static_cast<size_t>(i), Y = static_cast<size_t>(y), X = static_cast<size_t>(x);
        const double off = cube[I][Y * kSide + X] / 0.5 - rc[Y * kSide + X] - fr[I * kSide + Y] - fc[I * kSide + X] + f[I] + r[Y] + c[X] - whole;
        sum += off * off;
      }
  check("of pixels and frames", sum / (63.0 * 63.0 * 63.0), tvh, 63.0 * 63.0 * 63.0);
}

// PRNU goes with the light, the well is full, dark current doubles, a share is bad.
TEST(Detector, ResponseWellAndDark) {
  const Frame f = renderFrame(field("full_well: 1e9, bits: 16, gain: 1e-4, prnu: 0.02"));
  const Moments counts = momentsOf(pixels(f, "mw.counts"));
  const double electrons = momentsOf(pixels(f, "mw.electrons")).mean;
  figure("PRNU of 2 %, of the mean", std::sqrt(counts.variance - 1e-8 * electrons - 1.0 / 12.0) / counts.mean, 0.02, 4.0 * std::sqrt(0.5 / 4096.0),
         "4 standard errors");
  for (double v : pixels(renderFrame(field("full_well: 1e5, bits: 12")), "mw.counts")) ASSERT_EQ(v, 4095.0) << "a full well is the highest count";
  const auto dark = [](const char* kelvin) {
    return momentsOf(
               pixels(renderFrame(field(std::string("full_well: 1e9, bits: 16, gain: 1e-3, dark_current: 5e9 /s, dark_reference: 80 K, temperature: ") + kelvin,
                                        "counts", 20.0)),
                      "mw.counts"))
        .mean;
  };
  figure("dark counts 8 K warmer, of those before", dark("88 K") / dark("80 K"), 2.0, 1e-3, "doubles every 8 K");
  int low = 0, high = 0;
  for (double v : pixels(renderFrame(field("full_well: 1e8, offset: 10, bad_pixels: 0.1")), "mw.counts")) low += v == 10.0, high += v == 16383.0;
  bound("dead pixels off 5 %, in standard errors", std::abs(low - 204.8) / std::sqrt(194.6), 4.0, "binomial");
  bound("hot pixels off 5 %, in standard errors", std::abs(high - 204.8) / std::sqrt(194.6), 4.0, "binomial");
}

// The same frame alone, after others, and beside another camera; another frame is another.
TEST(Detector, NoiseIsTheFramesOwn) {
  const std::string law = "full_well: 7e6, read_noise: 300, dsnu: 100, prnu: 0.01, bad_pixels: 0.01";
  const Simulation sim = field(law, "counts", 300.0, "time: {rate: 60 Hz, frames: 4}\n");
  const auto third = pixels(renderFrame(sim, 3), "mw.counts");
  EXPECT_EQ(third, pixels(renderFrame(sim, 3), "mw.counts"));
  EXPECT_NE(third, pixels(renderFrame(sim, 2), "mw.counts"));
  // Another channel beside it changes nothing, and has noise of its own.
  const auto channels = [&](const std::string& which) {
    return renderFrame(scene(
        "seed: 11\nbackground: {temperature: 300 K}\ncameras: [{name: c, film: {width: 64, height: 64, pitch: 15 um}, focal_length: 100 mm, aperture: 25 mm, "
        "exposure: 4 ms, position: [0 m, 0 m, 0 m], heading: 0 deg, stages: [{stage: detector, " +
        law + "}], channels: [" + which + "]}]\n"));
  };
  const std::string b = "{name: b, response: {band: [3.5 um, 4.9 um]}, quantum_efficiency: 0.8, output: counts}", a = "{name: a" + b.substr(8);
  const Frame both = channels(a + ", " + b);
  EXPECT_EQ(pixels(both, "b.counts"), pixels(channels(b), "b.counts"));
  EXPECT_NE(pixels(both, "b.counts"), pixels(both, "a.counts"));
}

// A black body's apparent temperature is its own, off the axis too; by counts within what their noise and steps are.
TEST(Detector, ApparentTemperature) {
  const Frame f = renderFrame(
      scene("background: {temperature: 312.5 K}\ncameras: [{name: c, film: {width: 33, height: 33}, field_of_view: 60 deg, aperture: 25 mm, position: [0 m, 0 "
            "m, 0 m], heading: 0 deg, "
            "channels: [{name: mw, response: {wavelength: um, unit: \"1\", values: [[3.2, 0.1], [4, 1], [4.9, 0.3]]}, output: apparent_temperature}]}]\n"));
  double worst = 0.0;
  for (double v : pixels(f, "mw.apparent_temperature")) worst = std::max(worst, std::abs(v - 312.5));
  bound("apparent temperature of a black body of 312.5 K over 60 deg off [K]", worst, 2e-4, "a table of 1 % steps; single precision");
  const BandTemperature band(Spectrum::band(3.0, 5.0), 3.0, 5.0);
  EXPECT_EQ(band(1e12), 20000.0);
  const BandTemperature swir(Spectrum::band(1.0, 1.7), 1.0, 1.7);
  figure("dL/dT of 1.0-1.7 um at 300 K [W/(m2 sr K)]", swir.slope(300.0), (blackBodyBand(1.0, 1.7, 300.1) - blackBodyBand(1.0, 1.7, 299.9)) / 0.2, 2e-2,
         "a table of 1 % steps");
  const Frame counted = renderFrame(field("full_well: 1.2e7, bits: 14, read_noise: 300", "apparent_temperature"));
  const Moments kelvin = momentsOf(pixels(counted, "mw.apparent_temperature"));
  const double electrons = momentsOf(pixels(counted, "mw.electrons")).mean, slope = electrons * 0.0375;  // d ln N / dT at 300 K: about c2 / (lambda T^2)
  figure("mean apparent temperature by counts [K]", kelvin.mean, 300.0, 3e-6, "noise over the root of 4096 pixels");
  const double step = 1.2e7 / 16383.0;
  figure("its spread, the NETD [K]", std::sqrt(kelvin.variance), std::sqrt(electrons + 9e4 + step * step / 12.0) / slope, 0.06,
         "shot, read and rounding over dN/dT; slope by Wien's law");
}

// What `check` says of a camera by its design against what its frames show.
TEST(Detector, DesignFiguresAreFound) {
  const std::string law = "full_well: 2e6, bits: 14, read_noise: 500, dark_current: 1e7 /s, row_noise: 200, prnu: 0.002, dsnu: 300";
  const std::string film = "time: {rate: 60 Hz, frames: 32}\n";
  const Simulation warm = field(law, "counts", 301.0, film), cool = field(law, "counts", 299.0, film), middle = field(law, "counts", 300.0, film);
  const SensorFigures f = figuresOf(middle.cameras[0], middle.cameras[0].outputs[1]);
  ASSERT_TRUE(f.detected);
  figure("IFOV [rad]", f.ifov_rad, 1.5e-4, 1e-12, "15 um over 100 mm");
  // rms over 32 frames of each pixel, and of the pixels' means.
  std::vector<double> sums(kSide * kSide, 0.0), squares = sums;
  double slope = 0.0;
  for (int t = 0; t < 32; ++t) {
    const auto counts = pixels(renderFrame(middle, t), "mw.counts");
    for (size_t p = 0; p < counts.size(); ++p) sums[p] += counts[p], squares[p] += counts[p] * counts[p];
    slope += 0.5 * (momentsOf(pixels(renderFrame(warm, t), "mw.counts")).mean - momentsOf(pixels(renderFrame(cool, t), "mw.counts")).mean) / 32.0;
  }
  double temporal = 0.0;
  for (size_t p = 0; p < sums.size(); ++p) temporal += (squares[p] - sums[p] * sums[p] / 32.0) / 31.0 / static_cast<double>(sums.size());
  figure("NETD from frame to frame, of frames' own [mK]", 1e3 * std::sqrt(temporal) / slope, 1e3 * f.detected->netd_K, 0.02,
         "32 frames of 4096 pixels; rows are 64 a frame");
  for (double& v : sums) v /= 32.0;
  figure("NETD with what is fixed [mK]", 1e3 * std::sqrt(temporal + momentsOf(sums).variance - temporal / 32.0) / slope, 1e3 * f.detected->netdWithFixed_K,
         0.03, "4096 pixels' own responses");
  const auto saturated = [&](double kelvin) {
    int full = 0;
    for (double v : pixels(renderFrame(field(law, "counts", kelvin)), "mw.counts")) full += v >= 16350.0;  // read noise comes after the well
    return full / 4096.0;
  };
  bound("pixels that are full 2 K below saturation", saturated(f.detected->saturation_K - 2.0), 0.01, "PRNU of 0.2 %");
  bound("pixels that are not 2 K above", 1.0 - saturated(f.detected->saturation_K + 2.0), 0.01, "PRNU of 0.2 %");
}

// Cameras of the library by their design, beside the figures that their kinds are sold with.
TEST(Detector, LibrarySensorsAreOfTheirKind) {
  const auto figures = [](const std::string& name) {
    const Simulation sim = scene("cameras: [{name: c, sensor: " + name + ", position: [0 m, 0 m, 0 m], heading: 0 deg}]\n");
    for (const ChannelOutput& o : sim.cameras[0].outputs)
      if (o.detected) return figuresOf(sim.cameras[0], o);
    throw std::runtime_error(name);
  };
  for (const auto& [name, best_K, worst_K] :
       {std::tuple{"insb_640x512", 0.012, 0.025}, std::tuple{"mct_320x256", 0.010, 0.025}, std::tuple{"microbolometer_640x480_17um", 0.035, 0.050},
        std::tuple{"microbolometer_640x512_12um", 0.040, 0.060}}) {
    const auto f = figures(name);
    bound(std::string(name) + ", NETD [K]", f.detected->netd_K, worst_K, "data sheets of its kind");
    EXPECT_GT(f.detected->netd_K, best_K) << name;
    EXPECT_GT(f.detected->saturation_K, 320.0) << name;
  }
  for (const char* name : {"ingaas_640x512", "silicon_1440x1080"}) EXPECT_GT(figures(name).mtfAtNyquist, 0.3) << name;
  // One's own keys come first.
  const Simulation own = scene(
      "cameras: [{name: c, sensor: insb_640x512, film: {width: 32, height: 20, pitch: 15 um}, field_of_view: 1 deg, exposure: 3 ms, position: [0 m, 0 m, 0 m], "
      "heading: 0 deg}]\n");
  EXPECT_EQ(own.cameras[0].pinhole.width, 32);
  EXPECT_NEAR(own.cameras[0].pinhole.focalLength_m, 32 * 15e-6 / (2.0 * std::tan(0.5 * kPi / 180.0)), 1e-9);
  EXPECT_EQ(own.cameras[0].exposure_s, 3e-3);
}

TEST(Detector, RefusesWhatIsNone) {
  const auto refusal = [](const std::string& law, const std::string& output = "counts") -> std::string {
    try {
      (void)field(law, output);
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("full_well: 7e6, gain: 1e-8").find("less than a count"), std::string::npos);
  EXPECT_NE(refusal("full_well: 7e6, bits: 17").find("17"), std::string::npos);
  EXPECT_NE(refusal("full_well: 7e6, gain: -1").find("gain"), std::string::npos);
  EXPECT_NE(refusal("full_well: 7e6, bits: 8, offset: 300").find("an offset of 300"), std::string::npos);
  EXPECT_NE(refusal("full_well: 7e6}, {stage: detector, full_well: 1e6").find("a second detector"), std::string::npos);
  try {
    (void)scene(
        "cameras: [{name: c, film: {width: 4, height: 4}, field_of_view: 1 deg, aperture: 5 mm, exposure: 1 ms, position: [0 m, 0 m, 0 m], heading: 0 deg, "
        "channels: "
        "[{name: m, response: {band: [3 um, 5 um]}, quantum_efficiency: 0.8, output: counts}]}]\n");
    FAIL();
  } catch (const UserError& e) {
    EXPECT_NE(std::string(e.what()).find("'counts' needs a detector"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace pitviper::test
