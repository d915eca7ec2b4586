// A NETD as a design value: the read noise that follows from it, and the noise of pictures.
#include <gtest/gtest.h>

#include <cmath>

#include "sensors/figures.hpp"
#include "sim/model/stage.hpp"
#include "sim/parameters/error.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

Simulation flat(const std::string& detector, double kelvin, double fNumber, const std::string& lens = "", const std::string& outputs = "counts",
                const std::string& second = "") {
  return scene(print("seed: 7\ntime: {rate: 50 Hz, frames: 8}\nbackground: {temperature: %.9g K}\n", kelvin) +
               print("cameras: [{name: c, film: {width: 64, height: 64, pitch: 15 um}, focal_length: 100 mm, f_number: %g, exposure: 4 ms, position: [0 m, 0 "
                     "m, 0 m], heading: 0 deg, stages: [",
                     fNumber) +
               lens + "{stage: detector, " + detector + "}], channels: [{name: mw, response: {band: [3.5 um, 4.9 um]}, quantum_efficiency: 0.8, output: [" +
               outputs + "]}" + second + "]}]\n");
}

double meanOf(const std::vector<float>& v) {
  double sum = 0.0;
  for (float x : v) sum += static_cast<double>(x) / static_cast<double>(v.size());
  return sum;
}

/// From pictures alone: noise from frame to frame over what a kelvin does.
double measured_K(const std::string& detector, double kelvin, double fNumber, const std::string& lens) {
  const Simulation at = flat(detector, kelvin, fNumber, lens);
  constexpr int kFrames = 8;
  double variance = 0.0;
  std::vector<float> before;
  for (int k = 0; k < kFrames; ++k) {
    const auto now = layer(renderFrame(at, k), "mw.counts").pixels;
    for (std::size_t p = 0; k > 0 && p < now.size(); ++p)
      variance += 0.5 * std::pow(static_cast<double>(now[p]) - static_cast<double>(before[p]), 2.0) / static_cast<double>(now.size()) / (kFrames - 1);
    before = now;
  }
  const double rise = meanOf(layer(renderFrame(flat(detector, kelvin + 2.0, fNumber, lens)), "mw.counts").pixels) -
                      meanOf(layer(renderFrame(flat(detector, kelvin - 2.0, fNumber, lens)), "mw.counts").pixels);
  return std::sqrt(variance) / (rise / 4.0);
}

// The camera's own F-number, lens and dark current with it. Differences of 8 frames of 4096 pixels: the variance is good to sqrt(3 / (2 x 7 x 4096)) of it
// (neighbouring differences share a frame), the deviation to half of that, 0.36 %; four of that, and 0.1 % for the slope over 4 K.
TEST(Netd, IsWhatPicturesShow) {
  struct Case {
    const char* what;
    double netd_mK, at_K, fNumber;
    const char *more, *lens;
  };
  for (const Case& c : {Case{"30 mK, F/4", 30, 300, 4, "", ""},
                        {"60 mK, F/2.5", 60, 300, 2.5, "", ""},
                        {"200 mK, F/4, dark current", 200, 300, 4, ", dark_current: 5e7 /s", ""},
                        {"80 mK at 280 K", 80, 280, 3, ", netd_at: 280 K", ""},
                        {"40 mK, a fill factor of 0.6", 40, 300, 3, ", fill_factor: 0.6", ""},
                        {"40 mK, a warm lens", 40, 300, 3, "", "{stage: lens_emission, temperature: 310 K, emissivity: 0.1}, "}}) {
    const std::string detector = print("full_well: 2e7, bits: 16, offset: 500, netd: %g mK%s", c.netd_mK, c.more);
    figure(std::string("NETD of pictures [mK], design ") + c.what, 1e3 * measured_K(detector, c.at_K, c.fNumber, c.lens), c.netd_mK, 0.0155,
           "as asked; four standard errors and the slope");
    const Simulation sim = flat(detector, c.at_K, c.fNumber, c.lens);
    figure(std::string("NETD of figures [mK], design ") + c.what, 1e3 * figuresOf(sim.cameras[0], sim.cameras[0].outputs[0], 0.02, c.at_K).detected->netd_K,
           c.netd_mK, 1e-9, "by construction; rounding");
  }
}

// sigma^2 = (netd dN/dT)^2 - N - D - 1 / (12 gain^2).
TEST(Netd, ReadNoiseByHand) {
  for (const double netd_mK : {20.0, 50.0, 300.0}) {
    const Simulation sim = flat(print("full_well: 2e7, bits: 16, gain: 0.003, netd: %g mK, dark_current: 1e6 /s", netd_mK), 300.0, 3.0);
    const DetectorLaw& law = *detectorOf(sim.cameras[0], sim.cameras[0].outputs[0].channel);
    const auto d = *figuresOf(sim.cameras[0], sim.cameras[0].outputs[0]).detected;
    const double wanted = std::sqrt(std::pow(1e-3 * netd_mK * d.electrons_per_K, 2.0) - d.electronsAt300K - 1e6 * 4e-3 - 1.0 / (12.0 * 0.003 * 0.003));
    figure(print("read noise of a NETD of %g mK [electron]", netd_mK), law.sigmaTvh, wanted, 1e-9, "what the other noises leave of it");
  }
}

TEST(Netd, RefusesWhatCannotBe) {
  const auto refusal = [](const std::string& detector, const std::string& outputs = "counts", const std::string& second = "") -> std::string {
    try {
      (void)flat("full_well: 2e7, bits: 16, " + detector, 300.0, 4.0, "", outputs, second);
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  const std::string low = refusal("netd: 2 mK");
  EXPECT_NE(low.find("a NETD of 2 mK at 300 K in channel 'mw', where noise without read-out's alone makes"), std::string::npos) << low;
  EXPECT_NE(low.find("most of it shot noise of light"), std::string::npos) << low;
  // What it offers is taken.
  const auto at = low.find("expected a NETD of ");
  ASSERT_NE(at, std::string::npos) << low;
  EXPECT_EQ(refusal("netd: " + low.substr(at + 19, low.find(" or more") - at - 19)), "");
  EXPECT_NE(refusal("netd: 30 mK, read_noise: 100").find("a 'read_noise' and a 'netd'"), std::string::npos);
  EXPECT_NE(refusal("netd: 30 mK, reset_noise: 100").find("a 'reset_noise' and a 'netd'"), std::string::npos);
  EXPECT_NE(refusal("netd: 30 mK, flicker_corner: 1 Hz").find("a 'flicker_corner' and a 'netd'"), std::string::npos);
  EXPECT_NE(refusal("netd_at: 280 K").find("'netd_at' without a NETD"), std::string::npos);
  EXPECT_NE(refusal("netd: 30 mK, netd_at: 900 K").find("a detector that is full at 900 K"), std::string::npos);
  const std::string two = ", {name: lw, response: {band: [4.5 um, 5 um]}, quantum_efficiency: 0.7, output: counts}";
  EXPECT_NE(refusal("netd: 90 mK", "counts", two).find("counts in 2 channels"), std::string::npos);
  EXPECT_EQ(refusal("netd: 90 mK, netd_channel: lw", "counts", two), "");
  EXPECT_NE(refusal("netd: 90 mK, netd_channel: sw", "counts", two).find("counts in no channel 'sw'"), std::string::npos);
  EXPECT_EQ(refusal("netd: 30 mK", "radiance"), "");
}

}  // namespace
}  // namespace pitviper::test
