// What a detector makes of more than one frame or pixel: memory, 1/f noise, correction and drift, crosstalk, clusters, binning, windows; what it tells besides
// counts.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numeric>

#include "sensors/flicker_noise.hpp"
#include "sensors/signal_memory.hpp"
#include "sim/model/stage.hpp"
#include "scenarios/commands/commands.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/run/run.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// A film that a black body fills, 50 frames a second.
Simulation field(const std::string& detector, const std::string& output, double kelvin = 300.0, const std::string& more = "",
                 const std::string& film = "width: 64, height: 64, pitch: 15 um") {
  return scene("seed: 5\nbackground: {temperature: " + std::to_string(kelvin) + " K}\n" + more + "cameras: [{name: c, film: {" + film +
               "}, focal_length: 100 mm, aperture: 25 mm, exposure: 4 ms, position: [0 m, 0 m, 0 m], heading: 90 deg, stages: [{stage: detector, " + detector +
               "}], channels: [{name: mw, response: {band: [3.5 um, 4.9 um]}, quantum_efficiency: 0.8, output: [electrons, " + output + "]}]}]\n");
}

std::vector<double> pixels(const Frame& f, const std::string& name) {
  const auto& p = layer(f, name).pixels;
  return {p.begin(), p.end()};
}
double meanOf(const std::vector<double>& x) { return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size()); }
double varianceOf(const std::vector<double>& x) {
  const double m = meanOf(x);
  double sum = 0.0;
  for (double v : x) sum += (v - m) * (v - m);
  return sum / static_cast<double>(x.size() - 1);
}

// A wall that jumps from 290 to 310 K at frame 10: 1 - exp(-(n + 1) step / tau) of the step in the n-th frame after, and lag^(n + 1) left.
TEST(DetectorMemory, FollowsASlowDetectorsLaw) {
  const std::string wall =
      "time: {rate: 50 Hz, frames: 30}\nmaterials: {m: {components: []}}\nentities: [{name: w, shape: {model: plate, width: 100 m, height: 100 m}, material: "
      "m, temperature: 290 "
      "K, position: [1000 m, 0 m, 0 m], heading: 270 deg}]\ncommands: [{command: temperature, at: 0.2 s, entity: w, value: 310 K}]\n";
  for (const auto& [law, left] : {std::pair{"time_constant: 12 ms", std::exp(-20.0 / 12.0)}, std::pair{"lag: 0.3", 0.3}}) {
    const Simulation sim = field(std::string("full_well: 1e9, bits: 16, gain: 0.001, ") + law, "counts", 3.0, wall);
    const auto counts = [&](int frame) { return meanOf(pixels(renderFrame(sim, frame), "mw.counts")); };
    const double before = counts(9), after = counts(29);
    for (int n : {0, 1, 3})
      figure(print("step of a detector with %s, %d frames after", law, n), (counts(10 + n) - before) / (after - before), 1.0 - std::pow(left, n + 1), 3e-3,
             "shot noise over 4096 pixels, steps of a count");
  }
  const DetectorLaw both{.lag = 0.3, .timeConstant_s = 0.012};
  const auto weights = memoryWeights(both, 0.02);
  EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-12);
  EXPECT_LT(weights.size(), 24u);
}

// Alone, in a run from the start, and from another start: the same counts.
TEST(DetectorMemory, AFrameIsTheSameAloneAndInARun) {
  const Simulation sim = field(
      "full_well: 7e6, read_noise: 300, lag: 0.2, flicker_corner: 5 Hz, offset_drift: 100 /s, correction: {}, prnu: 0.02, dsnu: 500", "counts", 3.0,
      "time: {rate: 50 Hz, frames: 8}\nmaterials: {m: {components: []}}\nentities: [{name: w, shape: {model: sphere, radius: 2 m}, material: m, temperature: "
      "300 K, motion: [{time: 0 s, position: [1000 m, -4 m, 0 m]}, {time: 0.2 s, position: [1000 m, 4 m, 0 m]}]}]\n");
  needContext();
  std::vector<std::vector<std::vector<float>>> runs;
  for (int first : {0, 3, 6}) {
    auto& run = runs.emplace_back();
    runFrames(sim, shaderLibrary(), {first, 7}, [&](const std::shared_ptr<const Frame>& f) { run.push_back(layer(*f, "mw.counts").pixels); });
  }
  EXPECT_EQ(runs[0][6], runs[1][3]);
  EXPECT_EQ(runs[0][7], runs[2][1]);
  EXPECT_EQ(runs[0][3], layer(renderFrame(sim, 3), "mw.counts").pixels);
  EXPECT_NE(runs[0][3], runs[0][4]);
}

// A correction is learnt with the camera's own lens and exposure, whatever commands make of them meanwhile.
TEST(DetectorMemory, ACorrectionIsTheCamerasOwn) {
  const Simulation sim = field("full_well: 7e6, read_noise: 300, correction: {}, prnu: 0.02, nonlinearity: 0.02", "counts", 300.0,
                               "time: {rate: 50 Hz, frames: 4}\ncommands: [{command: look, at: 0.03 s, camera: c, field_of_view: 1.5 deg}]\n");
  needContext();
  std::vector<std::vector<float>> last;
  for (int first : {0, 3})
    runFrames(sim, shaderLibrary(), {first, 3}, [&](const std::shared_ptr<const Frame>& f) {
      if (f->number == 3) last.push_back(layer(*f, "mw.counts").pixels);
    });
  ASSERT_EQ(last.size(), 2u);
  EXPECT_EQ(last[0], last[1]);
}

// A periodogram over 2048 frames of 256 pixels: as much in each octave, and as dense as white read noise at the corner.
TEST(DetectorMemory, FlickerNoiseFallsAsOneOverF) {
  constexpr int kFrames = 2048, kPixels = 256;
  FlickerNoise noise(3, 7, kPixels);
  std::vector<std::vector<double>> series(kPixels);
  for (int f = 0; f < kFrames; ++f) {
    const std::vector<float>& now = noise.at(f);
    for (size_t p = 0; p < kPixels; ++p) series[p].push_back(static_cast<double>(now[p]));
  }
  // Density of variance a cycle a frame, two-sided folded into one: mean over pixels and over a third of an octave.
  const auto density = [&](double f) {
    double sum = 0.0;
    int count = 0;
    for (int k = static_cast<int>(f * 0.85 * kFrames); k <= static_cast<int>(f * 1.15 * kFrames); ++k)
      for (size_t p = 0; p < kPixels; p += 4, ++count) {
        std::complex<double> a = 0.0;
        for (int n = 0; n < kFrames; ++n) a += series[p][static_cast<size_t>(n)] * std::polar(1.0, -2.0 * kPi * k * n / kFrames);
        sum += 2.0 * std::norm(a) / kFrames;
      }
    return sum / count;
  };
  // Of an octave of variance 1 at a density c / f: c ln 2 = 1.
  for (double f : {0.01, 0.03, 0.1, 0.25})
    bound(print("1/f noise at %g of the frame rate, of its law, decibels off", f), std::abs(10.0 * std::log10(density(f) * f * std::log(2.0))), 1.3,
          "a sum of held octaves ripples; 64 pixels");
  // The corner: where it is as dense as the white noise, 2 sigma^2 a cycle a frame.
  const DetectorLaw law{.sigmaTvh = 50.0, .flickerCorner_Hz = 4.0};
  const double step = 0.02, octave = std::sqrt(law.flickerVariance(step));
  figure("density of 1/f noise at its corner by that of white noise", octave * octave / (std::log(2.0) * 4.0 * step) / (2.0 * 50.0 * 50.0), 1.0, 1e-12,
         "by definition");
  FlickerNoise again(3, 7, kPixels);
  EXPECT_EQ(std::vector<float>(noise.at(777)), again.at(777)) << "of a frame's number alone";
}

// Two-point correction: no pattern at both points but what its learning had; between them what bends leave; drift afterwards.
TEST(DetectorMemory, TwoPointCorrection) {
  const std::string law =
      "full_well: 2e7, bits: 16, gain: 0.003, prnu: 0.05, dsnu: 20000, nonlinearity: 0.01, correction: {low: 290 K, high: 320 K, frames: 1000000}";
  const auto pattern = [&](const std::string& more, double kelvin,
                           int frame = 0) {  // rms over pixels of means over 16 frames, less their shot noise [electron]
    const Simulation sim = field(law + more, "counts", kelvin, "time: {rate: 50 Hz, frames: 100000}\n");
    std::vector<double> mean(4096, 0.0);
    double electrons = 0.0;
    for (int k = 0; k < 16; ++k) {
      const Frame f = renderFrame(sim, frame + k);
      const auto counts = pixels(f, "mw.counts");
      for (size_t p = 0; p < mean.size(); ++p) mean[p] += counts[p] / 0.003 / 16.0;
      electrons = meanOf(pixels(f, "mw.electrons"));
    }
    const double rounding = 1.0 / (12.0 * 0.003 * 0.003);
    return std::pair{std::sqrt(std::max(0.0, varianceOf(mean) - (electrons + rounding) / 16.0)), electrons};
  };
  const auto [low, atLow] = pattern("", 290.0);
  const auto [high, atHigh] = pattern("", 320.0);
  const auto [middle, atMiddle] = pattern("", 307.0);
  bound("pattern left at the lower point, of its signal", low / atLow, 1e-4, "shot noise of 16 frames taken away; PRNU was 5 %");
  bound("pattern left at the upper point, of its signal", high / atHigh, 1e-4, "the same");
  figure("pattern left between, by what bends leave [electron]", middle, 0.01 / 2e7 * (atMiddle - atLow) * (atHigh - atMiddle), 0.06,
         "q (S - S1)(S - S2) / W; 4096 pixels, gains of 5 % within it");
  const auto [drifted, atDrift] = pattern(", offset_drift: 100 /s", 290.0, 5000);
  figure("pattern after 100 s of drift [electron]", drifted, 100.0 * 100.0, 0.06, "100 electrons a second; times gains of 5 %");
}

// A single bright pixel's worth of light is shared with four; the sum stays.
TEST(DetectorMemory, CrosstalkAndClusters) {
  const Simulation sim = scene(
      "background: {temperature: 3 K}\nlights: [{name: l, intensity: {wavelength: um, unit: W/(sr um), values: [[3, 0.1], [5, 0.1]]}, position: [1000 m, 0 m, "
      "0 m]}]\ncameras: [{name: c, "
      "film: {width: 17, height: 17, pitch: 15 um}, focal_length: 100 mm, aperture: 25 mm, exposure: 4 ms, position: [0 m, 0 m, 0 m], heading: 90 deg, stages: "
      "[{stage: "
      "detector, full_well: 1e9, bits: 16, gain: 0.01, crosstalk: 0.05}], channels: [{name: mw, response: {band: [3.5 um, 4.9 um]}, quantum_efficiency: 0.8, "
      "output: [electrons, "
      "counts, snr]}]}]\n");
  const Frame f = renderFrame(sim);
  const double electrons = at(layer(f, "mw.electrons"), f, 8, 8);
  ASSERT_GT(electrons, 1e5);
  const auto share = [&](int x, int y) { return at(layer(f, "mw.counts"), f, x, y) / 0.01 / electrons; };
  figure("share of its own pixel after crosstalk", share(8, 8), 0.8, 5e-3, "1 - 4 x 0.05; shot noise");
  figure("share of the pixel above", share(8, 7), 0.05, 0.02, "shot noise");
  EXPECT_NEAR(share(9, 9), 0.0, 1e-3);
  figure("its signal to noise", at(layer(f, "mw.snr"), f, 8, 8), 0.8 * electrons / std::sqrt(0.8 * electrons + 1.0 / (12.0 * 1e-4)), 1e-4,
         "N / sqrt(N + 1 / (12 K^2))");
  // Clusters of four: 2 % of 128 x 128 pixels, nearly each beside another.
  const Simulation bad = field("full_well: 1e8, offset: 10, bad_pixels: 0.02, bad_cluster: 4", "counts", 300.0, "", "width: 128, height: 128, pitch: 15 um");
  const Frame b = renderFrame(bad);
  int count = 0, alone = 0;
  const auto isBad = [&](int x, int y) {
    const double v = x < 0 || y < 0 || x > 127 || y > 127 ? 100.0 : at(layer(b, "mw.counts"), b, x, y);
    return v == 10.0 || v == 16383.0;
  };
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x)
      if (isBad(x, y)) ++count, alone += !isBad(x - 1, y) && !isBad(x + 1, y) && !isBad(x, y - 1) && !isBad(x, y + 1);
  figure("bad pixels in clusters of four", count, 0.02 * 16384.0, 0.35, "82 clusters: 4 standard errors");
  EXPECT_EQ(alone, 0);
}

// Binning: the light of four, dark current of four, noise of one read-out. A window: the same pixels.
TEST(DetectorMemory, BinningAndWindows) {
  const std::string law = "full_well: 1e8, bits: 16, gain: 0.0006, dark_current: 1e9 /s, read_noise: 9000";
  const Frame one = renderFrame(field(law, "counts")), four = renderFrame(field(law, "counts", 300.0, "", "width: 64, height: 64, pitch: 15 um, binning: 2"));
  EXPECT_EQ(four.width, 32);
  figure("electrons of four pixels as one", meanOf(pixels(four, "mw.electrons")), 4.0 * meanOf(pixels(one, "mw.electrons")), 1e-5, "their light together");
  figure("counts of four, dark current and all", meanOf(pixels(four, "mw.counts")), 4.0 * meanOf(pixels(one, "mw.counts")), 2e-3, "noise over 1024 pixels");
  const double electrons = meanOf(pixels(four, "mw.electrons")) + 4.0 * 4e6;
  figure("variance of their counts", varianceOf(pixels(four, "mw.counts")) / (0.0006 * 0.0006), electrons + 81e6 + 1.0 / (12.0 * 0.0006 * 0.0006),
         4.0 * std::sqrt(2.0 / 1024.0), "read noise once; 4 standard errors");
  const std::string noisy = "full_well: 7e6, read_noise: 300, prnu: 0.01";
  const Frame whole = renderFrame(field(noisy, "counts")),
              part = renderFrame(field(noisy, "counts", 300.0, "", "width: 64, height: 64, pitch: 15 um, window: [10, 20, 16, 8]"));
  ASSERT_EQ(part.width, 16);
  ASSERT_EQ(part.height, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) ASSERT_EQ(at(layer(part, "mw.counts"), part, x, y), at(layer(whole, "mw.counts"), whole, x + 10, y + 20));
}

// Codes for a screen are in the order of the counts, and noise of an empty scene is 4 codes rms about mid-grey.
TEST(DetectorMemory, DisplayCodes) {
  for (const char* agc : {"linear", "percentile", "plateau", "fixed"}) {
    const Frame f = renderFrame(field(std::string("full_well: 7e6, read_noise: 2000, agc: ") + agc, "counts, display"));
    const auto counts = pixels(f, "mw.counts"), codes = pixels(f, "mw.display");
    for (size_t p = 0; p + 1 < counts.size(); ++p) {
      ASSERT_TRUE(codes[p] >= 0.0 && codes[p] <= 255.0 && codes[p] == std::round(codes[p]));
      if (counts[p] < counts[p + 1]) {
        ASSERT_LE(codes[p], codes[p + 1]) << agc;
      }
    }
    // Rounding of counts (about 0.8 codes each) and codes adds (0.8^2 + 1) / 12; 4 standard errors of 4096 pixels are 4 %.
    if (std::string(agc) != "fixed") {
      figure(std::string("noise of a flat field on a screen, rms, ") + agc, std::sqrt(varianceOf(codes)), std::sqrt(16.0 + 1.64 / 12.0), 0.05,
             "4 codes; 4 standard errors of 4096 pixels, tails of the plateau");
      EXPECT_NEAR(meanOf(codes), 127.5, 1.0) << agc;
    }
  }
}

TEST(DetectorMemory, RefusesWhatIsNone) {
  const auto refusal = [](const std::string& law, const std::string& film = "width: 64, height: 64, pitch: 15 um") -> std::string {
    try {
      (void)field(law, "counts", 300.0, "", film);
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("full_well: 7e6, time_constant: 9 s").find("remembers"), std::string::npos);
  EXPECT_NE(refusal("full_well: 7e6, flicker_corner: 9 Hz").find("without white noise"), std::string::npos);
  EXPECT_NE(refusal("full_well: 7e6, correction: {low: 320 K, high: 300 K}").find("do not rise"), std::string::npos);
  EXPECT_NE(refusal("full_well: 7e6", "width: 63, height: 64, pitch: 15 um, binning: 2").find("does not divide"), std::string::npos);
  EXPECT_NE(refusal("full_well: 7e6", "width: 64, height: 64, pitch: 15 um, window: [60, 0, 8, 8]").find("not within"), std::string::npos);
}

}  // namespace
}  // namespace pitviper::test
