// Channels with an exposure, a lens and a detector of their own: what a camera with that channel alone would see, in one view.
#include <gtest/gtest.h>

#include <cmath>

#include "scenarios/commands/measure_bench.hpp"
#include "sensors/figures.hpp"
#include "sim/camera/exposure_parts.hpp"
#include "sim/model/stage.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

const char* const kMid = "{stage: detector, full_well: 7e6, bits: 14, read_noise: 500, prnu: 0.01, offset: 100, lag: 0.2}";
const char* const kLong =
    "{stage: detector, full_well: 4e7, bits: 16, read_noise: 2000, dark_current: 1e8 /s, dsnu: 3000, crosstalk: 0.02, offset: 300, correction: {low: 280 K, "
    "high: 320 K}}";
const char* const kMidChannel = "name: mw, response: {band: [3.6 um, 4.9 um]}, quantum_efficiency: 0.8, output: [counts, apparent_temperature, snr, electrons]";
const char* const kLongChannel = "name: lw, response: {band: [8 um, 10 um]}, quantum_efficiency: 0.6, output: [counts, apparent_temperature, saturated]";

/// A hot disc that moves before a wall of 300 K.
Simulation seen(const std::string& channels, const std::string& camera = "", const std::string& more = "") {
  return scene("seed: 9\ntime: {rate: 50 Hz, frames: 4}\nbackground: {temperature: 300 K}\n" + more +
               "entities: [{name: p, shape: {model: sphere, radius: 2 m}, material: blackbody, temperature: 420 K, motion: [{time: -1 s, position: [1000 m, 20 "
               "m, 0 m]}, {time: 1 s, position: [1000 m, -20 m, 0 m]}]}]\n"
               "cameras: [{name: c, film: {width: 48, height: 40, pitch: 15 um}, focal_length: 60 mm, f_number: 2, small_bodies: 0, position: [0 m, 0 m, 0 m], "
               "heading: 90 deg, " +
               camera + "channels: [" + channels + "]}]\n");
}
std::string channel(const char* keys, const std::string& own) { return std::string("{") + keys + (own.empty() ? "" : ", " + own) + "}"; }

void expectAlike(const Frame& both, const Frame& alone, const std::string& of) {
  int layers = 0;
  for (const FrameLayer& l : alone.layers) {
    if (l.name.rfind(of + ".", 0) != 0) continue;
    const FrameLayer& other = layer(both, l.name);
    ++layers;
    int off = 0;
    for (std::size_t p = 0; p < l.pixels.size(); ++p) off += !(l.pixels[p] == other.pixels[p] || (std::isnan(l.pixels[p]) && std::isnan(other.pixels[p])));
    EXPECT_EQ(off, 0) << l.name << ": pixels that are not those of a camera with this channel alone";
  }
  EXPECT_GE(layers, 3);
}

double number(const Frame& f, const std::string& name) {
  for (const auto& a : f.attributes)
    if (a.name == name) return std::get<double>(a.value);
  return NAN;
}

// Wherever exposure and detector are written, a channel is the same to the bit as in a camera of its own; what it does not say is the camera's.
TEST(ChannelsApart, AreWhatACameraOfEachWouldSee) {
  const std::string mid = std::string("stages: [") + kMid + "]", lw = std::string("stages: [") + kLong + "]";
  for (int frame : {0, 2}) {
    const Frame onlyMid = renderFrame(seen(channel(kMidChannel, ""), "exposure: 2 ms, " + mid + ", "), frame),
                onlyLong = renderFrame(seen(channel(kLongChannel, ""), "exposure: 0.1 ms, " + lw + ", "), frame);
    const Simulation ways[] = {seen(channel(kMidChannel, "exposure: 2 ms, " + mid) + ", " + channel(kLongChannel, "exposure: 0.1 ms, " + lw)),
                               seen(channel(kMidChannel, "") + ", " + channel(kLongChannel, "exposure: 0.1 ms, " + lw), "exposure: 2 ms, " + mid + ", "),
                               seen(channel(kLongChannel, "") + ", " + channel(kMidChannel, "exposure: 2 ms, " + mid), "exposure: 0.1 ms, " + lw + ", "),
                               seen(channel(kMidChannel, mid) + ", " + channel(kLongChannel, "exposure: 0.1 ms, " + lw), "exposure: 2 ms, ")};
    for (const Simulation& sim : ways) {
      const Frame both = renderFrame(sim, frame);
      expectAlike(both, onlyMid, "mw");
      expectAlike(both, onlyLong, "lw");
      EXPECT_EQ(number(both, "pitviper.exposure_s.mw"), 2e-3);
      EXPECT_EQ(number(both, "pitviper.exposure_s.lw"), 1e-4);
      EXPECT_EQ(number(both, "pitviper.exposure_s"), 2e-3) << "the longest";
      for (const char* of : {"gain_count_per_electron", "offset_count", "dark_electrons", "radiance_per_count", "radiance_at_0"}) {
        EXPECT_EQ(number(both, std::string("calibration.mw.counts.") + of), number(onlyMid, std::string("calibration.mw.counts.") + of)) << of;
        EXPECT_EQ(number(both, std::string("calibration.lw.counts.") + of), number(onlyLong, std::string("calibration.lw.counts.") + of)) << of;
      }
    }
    EXPECT_TRUE(std::isnan(number(onlyMid, "pitviper.exposure_s.mw"))) << "one exposure is told once";
  }
}

// A lens of its own: stages of one name take each other's place, others come together.
TEST(ChannelsApart, HaveALensOfTheirOwn) {
  const std::string common = "exposure: 2 ms, stages: [{stage: point_spread, cells: 2}, {stage: vignetting, v1: -4}, " + std::string(kMid) + "], ",
                    blur = "{stage: point_spread, cells: 2, diffraction: false, blur: 25 um}";
  const Simulation sim = seen(channel(kMidChannel, "") + ", " + channel(kLongChannel, "stages: [" + blur + ", " + kLong + "]"), common);
  const Camera& c = sim.cameras[0];
  ASSERT_EQ(c.stagesOf("lw").size(), 3u);
  EXPECT_EQ(c.stagesOf("lw")[0].name, "point_spread");
  EXPECT_EQ(c.stagesOf("lw")[1].name, "vignetting");
  EXPECT_EQ(c.stagesOf("lw")[2].name, "detector");
  const Simulation alone = seen(channel(kLongChannel, ""), "exposure: 2 ms, stages: [" + blur + ", {stage: vignetting, v1: -4}, " + kLong + "], ");
  const auto lwOf = [](const Simulation& s) {
    return *std::find_if(s.cameras[0].outputs.begin(), s.cameras[0].outputs.end(), [](const ChannelOutput& o) { return o.channel == "lw"; });
  };
  const SensorFigures both = figuresOf(c, lwOf(sim)), one = figuresOf(alone.cameras[0], lwOf(alone));
  EXPECT_EQ(both.mtfAtNyquist, one.mtfAtNyquist);
  EXPECT_EQ(both.detected->netd_K, one.detected->netd_K);
  EXPECT_NE(both.mtfAtNyquist, figuresOf(c, c.outputs[0]).mtfAtNyquist);
  const Frame f = renderFrame(sim), g = renderFrame(alone);
  double worst = 0.0;
  for (std::size_t p = 0; p < layer(f, "lw.counts").pixels.size(); ++p)
    worst = std::max(worst, static_cast<double>(std::abs(layer(f, "lw.counts").pixels[p] - layer(g, "lw.counts").pixels[p])));
  bound("counts of a channel with a lens of its own, off those of a camera of it alone", worst, 1.0,
        "margins differ, and with them the last digits of a transform: a rounding to counts");
  EXPECT_EQ(seen(channel(kLongChannel, std::string("stages: [") + kLong + "]") + ", " +
                     channel(kMidChannel, std::string("stages: [{stage: lens_emission, temperature: 290 K}, ") + kMid + "]"),
                 "exposure: 1 ms, ")
                .cameras[0]
                .stagesOf("mw")
                .size(),
            2u);
}

// Two exposures of one band in one frame with motion blur: each ramp as long as its own exposure.
TEST(ChannelsApart, MotionBlurOfTwoExposures) {
  const std::string band = "response: {band: [3.6 um, 4.9 um]}";
  const auto scenario = [&](const std::string& channels, const std::string& camera) {
    return scene(
        "time: {rate: 50 Hz, frames: 1}\nbackground: {temperature: 3 K}\nentities: [{name: p, shape: {model: plate, width: 30 m, height: 60 m}, material: "
        "blackbody, temperature: 400 K, "
        "motion: [{time: -1 s, position: [1000 m, 315 m, 0 m], heading: 270 deg}, {time: 1 s, position: [1000 m, -285 m, 0 m], heading: 270 deg}]}]\n"
        "cameras: [{name: c, film: {width: 64, height: 8, pitch: 15 um}, focal_length: 100 mm, aperture: 25 mm, samples: 8, small_bodies: 0, position: [0 m, 0 "
        "m, 0 m], heading: 90 deg, motion_blur: true, " +
        camera + "channels: [" + channels + "]}]\n");
  };
  // 300 m/s are 2000 pixels a second: 20 pixels of 10 ms, 4 of 2 ms, 1 of 0.5 ms.
  const Simulation sim =
      scenario("{name: a, " + band + ", exposure: 10 ms}, {name: b, " + band + ", exposure: 2 ms}, {name: d, " + band + "}", "exposure: 0.5 ms, ");
  EXPECT_EQ(exposureParts(sim, sim.cameras[0], [&sim](double t) { return advance(sim, t); }, 0.0).rowWeights.size(), 3u);
  const Frame f = renderFrame(sim);
  const double whole = blackBodyBand(3.6, 4.9, 400.0);
  for (const auto& [name, exposure_s] : {std::pair{"a.radiance", 10e-3}, std::pair{"b.radiance", 2e-3}, std::pair{"d.radiance", 0.5e-3}}) {
    const double way = 2000.0 * exposure_s;
    double worst = 0.0, between = 0.0;
    // The front edge goes from the middle less half its way to the middle and half: a ramp, averaged over a pixel.
    const auto ramp = [&](double x) {
      const double u = std::clamp(x + 0.5 * way, 0.0, way);
      return u * u / (2.0 * way) + std::max(0.0, x - 0.5 * way);
    };
    for (int column = 10; column < 54; ++column) {
      const double found = at(layer(f, name), f, column, 4) / whole;
      const double right = 1.0 - (ramp(column - 31.0) - ramp(column - 32.0)), left = ramp(column - 31.0) - ramp(column - 32.0);
      worst = std::max(worst, std::min(std::abs(found - right), std::abs(found - left)));
      between += found > 0.01 && found < 0.99;
    }
    EXPECT_NEAR(between, way, 1.5) << "pixels that the edge goes over";
    bound(print("an edge through an exposure of %g ms of three in one frame, of its contrast", 1e3 * exposure_s), worst, 0.02,
          "1 % of parts, and an eighth of a subpixel's edge over the way");
  }
}

TEST(ChannelsApart, CommandsNameAChannel) {
  const std::string mid = std::string("exposure: 2 ms, stages: [") + kMid + "]", lw = std::string("exposure: 0.1 ms, stages: [") + kLong + "]";
  const std::string both = channel(kMidChannel, mid) + ", " + channel(kLongChannel, lw);
  const Simulation sim = seen(both, "",
                              "commands: [{command: look, at: 0.02 s, camera: c, channel: lw, exposure: 0.05 ms}, {command: gain, at: 0.02 s, camera: c, "
                              "channel: mw, factor: 0.5}, {command: gain, at: 0.06 s, camera: c, factor: 2}]\n");
  const Frame before = renderFrame(sim, 0), after = renderFrame(sim, 2), last = renderFrame(sim, 3);
  EXPECT_EQ(number(before, "pitviper.exposure_s.lw"), 1e-4);
  EXPECT_EQ(number(after, "pitviper.exposure_s.lw"), 5e-5);
  EXPECT_EQ(number(after, "pitviper.exposure_s.mw"), 2e-3);
  const std::string gain = ".counts.gain_count_per_electron";
  EXPECT_EQ(number(after, "calibration.mw" + gain), 0.5 * number(before, "calibration.mw" + gain));
  EXPECT_EQ(number(after, "calibration.lw" + gain), number(before, "calibration.lw" + gain));
  EXPECT_EQ(number(last, "calibration.mw" + gain), 2.0 * number(before, "calibration.mw" + gain));
  EXPECT_EQ(number(last, "calibration.lw" + gain), 2.0 * number(before, "calibration.lw" + gain));
  const Frame so = renderFrame(seen(channel(kLongChannel, std::string("exposure: 0.05 ms, stages: [{stage: detector, full_well: 4e7, bits: 16, read_noise: "
                                                                      "2000, dark_current: 1e8 /s, dsnu: 3000, crosstalk: 0.02, offset: 300}]"))),
                               2),
              uncorrected = renderFrame(seen(channel(kMidChannel, mid) + ", " +
                                                 channel(kLongChannel,
                                                         "exposure: 0.1 ms, stages: [{stage: detector, full_well: 4e7, bits: 16, read_noise: 2000, "
                                                         "dark_current: 1e8 /s, dsnu: 3000, crosstalk: 0.02, offset: 300}]"),
                                             "", "commands: [{command: look, at: 0.02 s, camera: c, channel: lw, exposure: 0.05 ms}]\n"),
                                        2);
  expectAlike(uncorrected, so, "lw");
  // Over time.
  const Simulation course = seen(channel(kMidChannel, "exposure: [[0 s, 1 ms], [0.06 s, 4 ms]], stages: [" + std::string(kMid) + "]"));
  EXPECT_NEAR(number(renderFrame(course, 1), "pitviper.exposure_s.mw"), 2e-3, 1e-12);
}

// The lab bench measures each channel by its own exposure and detector.
TEST(ChannelsApart, AreMeasuredOneByOne) {
  needContext();
  BenchOptions options;
  options.base = ".";
  options.frames = 8, options.film_px = 64;
  options.camera =
      "  film: {width: 96, height: 80, pitch: 15 um}\n  focal_length: 100 mm\n  f_number: 2\n  channels:\n"
      "  - {name: mw, response: {band: [3.6 um, 4.9 um]}, quantum_efficiency: 0.8, output: counts, exposure: 2 ms, stages: [{stage: detector, full_well: 7e6, "
      "bits: 14, offset: 100, read_noise: 400}]}\n"
      "  - {name: lw, response: {band: [8 um, 9.5 um]}, quantum_efficiency: 0.6, output: counts, exposure: 0.15 ms, stages: [{stage: point_spread, cells: 1, "
      "defocus: 20 um}, {stage: detector, full_well: 3e7, bits: 15, offset: 300, read_noise: 1500}]}\n";
  const auto results = measureCamera(options, {});
  ASSERT_EQ(results.size(), 2u);
  for (const BenchResult& r : results)
    for (const BenchFigure& f : r.figures)
      if (f.name == "SiTF" || f.name == "full well, or what the converter holds")
        figure(r.channel + ", " + f.name + " from pictures of a camera of two channels", f.measured, f.design, 0.02,
               "the channel's own exposure, gain and well; 8 frames of 4096 pixels");
  EXPECT_GT(std::abs(results[0].figures[1].design / results[1].figures[1].design - 1.0), 0.05);
}

TEST(ChannelsApart, WhatIsWrongIsNamed) {
  const auto refusal = [](const std::string& channels, const std::string& camera = "", const std::string& more = "") -> std::string {
    try {
      (void)seen(channels, camera, more);
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  const auto expect = [&](const std::string& said, const char* words) { EXPECT_NE(said.find(words), std::string::npos) << said; };
  const std::string mid = channel(kMidChannel, std::string("exposure: 2 ms, stages: [") + kMid + "]"),
                    lw = channel(kLongChannel, std::string("exposure: 1 ms, stages: [") + kLong + "]");
  expect(refusal(channel(kMidChannel, std::string("exposure: 1 ms, stages: [{stage: distortion, k1: 0.1}, ") + kMid + "]")), "a distortion of one channel");
  expect(refusal(mid + ", " + lw, "", "commands: [{command: look, camera: c, exposure: 1 ms}]\n"), "has an exposure of its own");
  expect(refusal(mid + ", " + lw, "", "commands: [{command: look, camera: c, channel: sw, exposure: 1 ms}]\n"), "'sw'");
  expect(refusal(mid + ", " + lw, "", "commands: [{command: look, camera: c, channel: mw, heading: 80 deg}]\n"), "without an exposure to set");
  expect(refusal(channel(kMidChannel, std::string("stages: [") + kMid + "]"), "exposure: 1 ms, ",
                 "commands: [{command: look, camera: c, channel: mw, exposure: 1 ms}]\n"),
         "has the exposure of its camera");
  expect(refusal(channel(kMidChannel, "exposure: 1 ms"), std::string("stages: [") + kMid + "], ",
                 "commands: [{command: gain, camera: c, channel: mw, factor: 2}]\n"),
         "with a detector of its own");
  expect(refusal(channel(kMidChannel, std::string("stages: [") + kMid + "]")), "needs an exposure time");
  expect(refusal(channel(kMidChannel, "exposure: 1 ms")), "needs a detector");
  expect(refusal(mid + ", " + lw, "exposure: 1 ms, "), "an exposure that no channel of camera 'c' has");
  expect(refusal(mid + ", " + lw, std::string("stages: [{stage: point_spread}, ") + kMid + "], "), "a stage that no channel of camera 'c' has");
  EXPECT_EQ(refusal(mid + ", " + lw, "stages: [{stage: point_spread}], "), "");
  expect(refusal(channel(kMidChannel, std::string("exposure: 1 ms, stages: [") + kMid + ", " + kMid + "]")), "a second detector");
  try {
    (void)scene("probes: [{name: p, position: [0 m, 0 m, 0 m], channels: [{name: x, response: {band: [3 um, 5 um]}, exposure: 1 ms}]}]\n");
    ADD_FAILURE() << "a probe's channel has no exposure";
  } catch (const UserError& e) {
    expect(e.what(), "of a channel that is not a camera's");
  }
}

}  // namespace
}  // namespace pitviper::test
