// Pixels whose counts say nothing: no number that is made of them may be taken for a measurement.
#include <gtest/gtest.h>

#include <cmath>

#include "scenarios/commands/run_notes.hpp"
#include "sensors/figures.hpp"
#include "sim/frame/frame_picture.hpp"
#include "sim/frame/mark_header.hpp"
#include "sim/image/grey_codes.hpp"
#include "sim/stream/stream_picture.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Six black plates side by side, 4 x 24 pixels each, before one of 300 K; a pixel is 0.1 m.
const std::vector<double> kPlates_K{250.0, 300.0, 360.0, 450.0, 900.0, 2500.0};

Simulation plates(const std::string& detector, const std::string& more = "", const std::string& camera = "truth: [temperature], ",
                  const std::string& band = "3.7 um, 4.8 um") {
  std::string text = "seed: 5\nbackground: {temperature: 300 K}\n" + more + "entities:\n";
  for (std::size_t k = 0; k < kPlates_K.size(); ++k)
    text += print(
        "  - {name: p%zu, shape: {model: plate, width: 0.4 m, height: 4 m}, material: blackbody, temperature: %g K, position: [100 m, %g m, 0 m], heading: 270 "
        "deg}\n",
        k, kPlates_K[k], 1.0 - 0.4 * static_cast<double>(k));
  return scene(text +
               "cameras: [{name: c, film: {width: 24, height: 24, pitch: 20 um}, focal_length: 20 mm, aperture: 10 mm, exposure: 1 ms, small_bodies: 0, "
               "position: [0 m, 0 m, 0 m], heading: 90 deg, " +
               camera + "channels: [{name: mw, response: {band: [" + band +
               "]}, quantum_efficiency: 0.8, output: [counts, apparent_temperature, snr, saturated]}], stages: [{stage: detector, " + detector + "}]}]\n");
}

int attribute(const Frame& f, const std::string& name) {
  for (const auto& a : f.attributes)
    if (a.name == name) return std::get<int>(a.value);
  return -1;
}

/// Of pixels that are not marked, how far their temperature is off the plate's in standard deviations of what the design says of that temperature.
struct Told {
  int marked = 0, hot = 0;
  double worst = 0.0;
};
Told told(const Simulation& sim, const Frame& f) {
  Told t;
  const FrameLayer &apparent = layer(f, "mw.apparent_temperature"), &marks = layer(f, "mw.saturated"), &snr = layer(f, "mw.snr"),
                   &truth = layer(f, "truth.temperature");
  for (std::size_t p = 0; p < apparent.pixels.size(); ++p) {
    const bool marked = marks.pixels[p] != 0.0f;
    EXPECT_EQ(std::isnan(apparent.pixels[p]), marked) << p;
    EXPECT_EQ(std::isnan(snr.pixels[p]), marked) << p;
    t.marked += marked;
    const double kelvin = truth.pixels[p] > 0.0f ? static_cast<double>(truth.pixels[p]) : 300.0;
    t.hot += kelvin > 2000.0;
    if (marked) continue;
    const SensorFigures of = figuresOf(sim.cameras[0], sim.cameras[0].outputs[0], sim.time.step_s, kelvin);
    t.worst = std::max(t.worst, std::abs(static_cast<double>(apparent.pixels[p]) - kelvin) / of.detected->netdWithFixed_K);
  }
  return t;
}

// Whatever cuts the count: what still has a number is right, what has none is marked and counted.
TEST(Saturation, NoNumberIsTakenForATemperature) {
  for (const char* detector :
       {"full_well: 2e6, bits: 14, read_noise: 300", "full_well: 2e6, bits: 14, read_noise: 2000, offset: 300",
        "full_well: 1e9, gain: 0.004, bits: 14, read_noise: 200", "full_well: 3e6, bits: 16, gain: 0.01, read_noise: 500, dark_current: 4e8 /s, offset: 500",
        "full_well: 5e5, bits: 12, gain: 0.02, offset: 20"}) {
    const Simulation sim = plates(detector);
    const Frame f = renderFrame(sim);
    const Told t = told(sim, f);
    EXPECT_GE(t.marked, t.hot) << detector;
    bound(std::string("temperatures that have no mark, off the plates', in standard deviations: ") + detector, t.worst, 5.0,
          "576 normal numbers; 5 sigma is one in 1.7 million");
    EXPECT_EQ(attribute(f, "pitviper.saturated.mw.full") + attribute(f, "pitviper.saturated.mw.lowest"), t.marked) << detector;
    EXPECT_EQ(attribute(f, "pitviper.saturated.mw.bad"), 0);
  }
}

// Where pixels differ, a full one's count, corrected, is anything: the mark is made in the well.
TEST(Saturation, CorrectionDoesNotHideIt) {
  const Simulation sim = plates(
      "full_well: 2e6, bits: 16, gain: 0.01, read_noise: 300, prnu: 0.1, dsnu: 20000, nonlinearity: 0.01, offset: 2000, correction: {low: 290 K, high: 360 K, "
      "frames: 4096}");
  const Frame f = renderFrame(sim);
  double least = INFINITY, most = 0.0;
  int full = 0;
  for (std::size_t p = 0; p < f.layers[0].pixels.size(); ++p)
    if (layer(f, "truth.temperature").pixels[p] > 800.0f) {
      EXPECT_EQ(layer(f, "mw.saturated").pixels[p], 1.0f);
      EXPECT_TRUE(std::isnan(layer(f, "mw.apparent_temperature").pixels[p]));
      least = std::min(least, static_cast<double>(layer(f, "mw.counts").pixels[p])),
      most = std::max(most, static_cast<double>(layer(f, "mw.counts").pixels[p]));
      ++full;
    }
  EXPECT_EQ(full, 192);
  EXPECT_GT(most - least, 1000.0) << "a threshold on counts would not find them";
}

// The limit: a body that just fills the pixel, by the channel's own Planck integral.
TEST(Saturation, TheLimitIsABound) {
  for (const char* detector : {"full_well: 2e6, bits: 14, saturated: limit, bad_pixels: 0.1", "full_well: 1e9, gain: 0.004, bits: 14, saturated: limit",
                               "full_well: 2e6, bits: 14, saturated: limit, fill_factor: 0.6, dark_current: 1e8 /s, offset: 100"}) {
    const Simulation sim = plates(detector);
    const Frame f = renderFrame(sim);
    const SensorFigures design = figuresOf(sim.cameras[0], sim.cameras[0].outputs[0]);
    double worst = 0.0;
    int full = 0, bad = 0;
    for (std::size_t p = 0; p < f.layers[0].pixels.size(); ++p) {
      const double kelvin = static_cast<double>(layer(f, "mw.apparent_temperature").pixels[p]), mark = static_cast<double>(layer(f, "mw.saturated").pixels[p]);
      EXPECT_EQ(std::isnan(kelvin), mark == 3.0);
      bad += mark == 3.0;
      if (mark != 1.0) continue;
      ++full;
      worst = std::max(worst, std::abs(kelvin - design.detected->saturation_K));
      EXPECT_GT(static_cast<double>(layer(f, "truth.temperature").pixels[p]), kelvin - 2.0);
      EXPECT_LE(layer(f, "mw.snr").pixels[p], std::sqrt(2e6f) * 1.0001f + (std::string(detector).find("1e9") != std::string::npos ? 1e4f : 0.0f));
    }
    EXPECT_GT(full, 0);
    EXPECT_EQ(bad, attribute(f, "pitviper.saturated.mw.bad"));
    bound(std::string("temperatures of full pixels, off that which saturates, K: ") + detector, worst, 0.02,
          "off the axis a pixel sees cos^4 of it: 3e-4 of the light here");
  }
}

TEST(Saturation, GainWindowAndDarkCodes) {
  const std::string cold = "full_well: 5e6, bits: 14, read_noise: 300";
  const Simulation dark = plates(cold + ", gain: 1e-6");
  EXPECT_GT(attribute(renderFrame(dark), "pitviper.saturated.mw.lowest"), 90) << "a plate of 250 K gives less than half a count";
  // A gain that is turned up fills the converter, and down again.
  const Simulation gains = plates("full_well: 1e8, bits: 14, read_noise: 300, gain: 5e-4",
                                  "time: {rate: 10 Hz, frames: 2}\ncommands: [{command: gain, at: 0.1 s, camera: c, factor: 60}]\n");
  EXPECT_LT(attribute(renderFrame(gains, 0), "pitviper.saturated.mw.full"), attribute(renderFrame(gains, 1), "pitviper.saturated.mw.full"));
  // What is not read out is not counted.
  const std::string window = "full_well: 2e6, bits: 14";
  const Simulation whole = plates(window);
  Simulation part = plates(window);
  part.cameras[0].window = glm::ivec4(20, 4, 4, 8);
  EXPECT_EQ(attribute(renderFrame(part), "pitviper.saturated.mw.full"), 32);
  EXPECT_GE(attribute(renderFrame(whole), "pitviper.saturated.mw.full"), 96);
}

// A bolometer that warms, a detector that shares: marks are of what the well has got, not of the light.
TEST(Saturation, MarksAreOfWhatIsCounted) {
  // From 300 K to 900 K at frame 0: with a time constant of two frames the signal reaches a well of 60 % of it at frame 1 or later.
  const std::string step = "time: {rate: 100 Hz, frames: 12, start: 0 s}\ncommands: [{command: temperature, at: 0.005 s, entity: p3, value: 900 K}]\n";
  const auto of = [&](const std::string& law, int frame) { return attribute(renderFrame(plates(law, step), frame), "pitviper.saturated.mw.full"); };
  const Simulation sim = plates("full_well: 1e9");
  const double hot = figuresOf(sim.cameras[0], sim.cameras[0].outputs[0], 0.01, 900.0).detected->electronsAt300K;
  const std::string law = print("full_well: %g, bits: 14, time_constant: 20 ms", 0.6 * hot);
  const int before = of(law, 0), soon = of(law, 1), later = of(law, 10);
  EXPECT_EQ(soon, before) << "after one frame the warming has 1 - exp(-1/2) = 39 % of it";
  EXPECT_EQ(later, before + 96) << "after ten 99 %";
  // A well of 85 % of a plate's own light is not full where a tenth of it goes to each neighbour, of a column one pixel wide; in the middle of the plate it is.
  const Frame shared = renderFrame(plates(
      print("full_well: %g, bits: 14, crosstalk: 0.08", 0.97 * figuresOf(sim.cameras[0], sim.cameras[0].outputs[0], 0.01, 900.0).detected->electronsAt300K)));
  const Frame alone = renderFrame(plates(print("full_well: %g, bits: 14", 0.97 * hot)));
  EXPECT_EQ(attribute(alone, "pitviper.saturated.mw.full"), 192);
  EXPECT_LT(attribute(shared, "pitviper.saturated.mw.full"), 192) << "the column towards the cooler plate gives more than it gets";
  EXPECT_GT(attribute(shared, "pitviper.saturated.mw.full"), 140);
}

TEST(Saturation, RunsTellOfIt) {
  const auto notes = [](const std::vector<Simulation>& runs) {
    Notes said;
    FrameNotes of(said);
    for (const Simulation& sim : runs) of.look(renderFrame(sim));
    return said.all();
  };
  const auto part = notes({plates("full_well: 2e6, bits: 14, offset: 100"), plates("full_well: 2e6, bits: 14, offset: 100")});
  ASSERT_EQ(part.size(), 1u) << "once";
  EXPECT_NE(part[0].find("camera c, channel mw, frame 0:"), std::string::npos) << part[0];
  EXPECT_NE(part[0].find("of 576 pixels"), std::string::npos) << part[0];
  const auto whole = notes({plates("full_well: 2e6, bits: 14, offset: 100"), plates("full_well: 1000, bits: 10, offset: 10")});
  ASSERT_EQ(whole.size(), 2u);
  EXPECT_NE(whole[1].find("the whole picture is full"), std::string::npos) << whole[1];
  EXPECT_TRUE(notes({plates("full_well: 1e12, bits: 16, gain: 1e-6, offset: 100, read_noise: 3e7")}).empty()) << "nothing is full";
  const auto dark = notes({plates("full_well: 1e12, bits: 16, gain: 1e-9")});
  ASSERT_EQ(dark.size(), 1u);
  EXPECT_NE(dark[0].find("at the converter's lowest code"), std::string::npos) << dark[0];
}

// A target whose best pixel is full has no signal to noise; its row counts the full pixels.
TEST(Saturation, TargetsSayIt) {
  const Frame f = renderFrame(plates("full_well: 2e6, bits: 14, offset: 100", "", "truth: [targets], "));
  ASSERT_EQ(f.targets.size(), kPlates_K.size());
  for (std::size_t k = 0; k < f.targets.size(); ++k) {
    const TargetRow::Channel& c = f.targets[k].channels.at(0);
    EXPECT_EQ(std::isnan(c.signalToNoise), kPlates_K[k] > 310.0) << k;
    if (kPlates_K[k] > 310.0) { EXPECT_GE(c.saturated, 96) << k; }
    if (k == 0) { EXPECT_EQ(c.saturated, 0); }
  }
}

// Pictures for people keep their scale; codes of a stream have their highest where there is no number.
TEST(Saturation, PicturesAndStreams) {
  const Simulation sim = plates("full_well: 2e6, bits: 14, offset: 100");
  const Frame f = renderFrame(sim);
  const FrameLayer& apparent = layer(f, "mw.apparent_temperature");
  const PictureScale scale = PictureScale::of(apparent.pixels);
  EXPECT_GT(scale.low(), 240.0);
  EXPECT_LT(scale.high(), 500.0);
  CommonScale common;
  for (int k = 0; k < 3; ++k) common.add(apparent.pixels);
  EXPECT_EQ(common.scale().low(), scale.low());
  CommonScale nothing;
  nothing.add(std::vector<float>(9, NAN));
  EXPECT_TRUE(std::isfinite(nothing.scale().low()) && nothing.scale().low() < nothing.scale().high());
  const std::vector<float> values{NAN, 250.0f, 300.0f, 1e9f, -5.0f};
  std::vector<std::uint16_t> codes(values.size());
  toGreyCodes(values, 200.0, 1.0, 4095, codes);
  EXPECT_EQ(codes, (std::vector<std::uint16_t>{4095, 50, 100, 4095, 0}));
  StreamCoder coder(sim.cameras[0], "", {}, {});
  StreamPicture picture;
  coder.code(f, picture);
  EXPECT_GE(picture.outside, static_cast<std::size_t>(attribute(f, "pitviper.saturated.mw.full"))) << "a stream's flag of saturation";
  (void)pictureOf(f);
}

}  // namespace
}  // namespace pitviper::test
