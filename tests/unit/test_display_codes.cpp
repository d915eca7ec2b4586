// Codes for a screen against closed forms on known histograms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sensors/display_codes.hpp"
#include "sim/frame/frame_picture.hpp"
#include "sim/stream/stream_picture.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

DetectorLaw lawOf(Agc agc, double gain = 0.0) {
  DetectorLaw law;
  law.display.agc = agc;
  law.display.most_codesPerCount = gain;
  return law;
}

std::vector<float> shown(std::vector<float> counts, const DetectorLaw& law, double noise_counts = 1.0) {
  toDisplayCodes(counts, law, noise_counts);
  return counts;
}

std::vector<float> emptyScene(double level, double sigma, int pixels = 65536) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(level, sigma);
  std::vector<float> counts;
  for (int k = 0; k < pixels; ++k) counts.push_back(static_cast<float>(std::round(normal(random))));
  return counts;
}

double deviation(const std::vector<float>& v) {
  double mean = 0.0, sum = 0.0;
  for (float x : v) mean += static_cast<double>(x) / static_cast<double>(v.size());
  for (float x : v) sum += (static_cast<double>(x) - mean) * (static_cast<double>(x) - mean) / static_cast<double>(v.size());
  return std::sqrt(sum);
}
double medianOf(std::vector<float> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return static_cast<double>(v[v.size() / 2]);
}

// As many pixels at each of n counts: both ways are a straight line over the whole screen, the m-th count at 255 (m + 1/2) / n.
TEST(DisplayCodes, EvenHistogramIsAStraightLine) {
  for (const Agc agc : {Agc::Linear, Agc::Plateau})
    for (const int n : {100, 300, 1000, 4000}) {
      DetectorLaw law = lawOf(agc, 255.0);
      law.display.tails = 0.0;
      std::vector<float> counts;
      for (int k = 0; k < 4 * n; ++k) counts.push_back(static_cast<float>(700 + k % n));
      const auto codes = shown(counts, law);
      double worst = 0.0;
      for (std::size_t k = 0; k < codes.size(); ++k)
        worst = std::max(worst, std::abs(static_cast<double>(codes[k]) - 255.0 * (static_cast<double>(k % static_cast<std::size_t>(n)) + 0.5) / n));
      bound(print("display: %d even counts, %s, off a line [code]", n, agc == Agc::Linear ? "linear" : "plateau"), worst, 0.5 + 1e-6,
            "255 (m + 1/2) / n; rounding to whole codes");
    }
}

// The tails cut what few pixels have: of 1000 even counts 5 at either end are black and white.
TEST(DisplayCodes, TailsAreCut) {
  std::vector<float> counts;
  for (int k = 0; k < 100000; ++k) counts.push_back(static_cast<float>(2000 + k % 1000));
  const auto codes = shown(counts, lawOf(Agc::Linear, 255.0));
  // From the count below which, with its own, 0.5 % lie, 2004, to that of 99.5 %, 2994: 991 counts.
  for (const int k : {0, 4, 100, 500, 994, 999})
    EXPECT_NEAR(codes[static_cast<std::size_t>(k)], std::clamp(255.0 * (k - 4 + 0.5) / 991.0, 0.0, 255.0), 0.51) << k;
}

// Half the pixels at A, half at B = A + D. Linear: D codes times the gain, or from end to end. Plateau: each level has 255 (0.8 / 2 + 0.2 / (D + 1)) codes,
// each count between them 255 x 0.2 / (D + 1), none more than the gain.
TEST(DisplayCodes, TwoLevels) {
  for (const auto& [distance, gain] : {std::pair{400, 0.5}, std::pair{40, 0.5}, std::pair{400, 255.0}, std::pair{9000, 0.8}, std::pair{1, 20.0}}) {
    std::vector<float> counts;
    for (int k = 0; k < 20000; ++k) counts.push_back(static_cast<float>(3000 + (k % 2) * distance));
    const double n = distance + 1.0;
    const auto linear = shown(counts, lawOf(Agc::Linear, gain)), plateau = shown(counts, lawOf(Agc::Plateau, gain));
    EXPECT_NEAR(static_cast<double>(linear[1] - linear[0]), distance * std::min(gain, 255.0 / n), 1.01) << distance;
    const double level = std::min(gain, 255.0 * (0.4 + 0.2 / n)), between = std::min(gain, 51.0 / n);
    EXPECT_NEAR(static_cast<double>(plateau[1] - plateau[0]), (distance - 1) * between + level, 1.01) << distance;
  }
}

// What an empty scene has is noise: at most as many codes rms as are asked for, about mid-grey, whatever the noise is; nothing near black and white. (Before, a
// plateau spread it from black to white.)
TEST(DisplayCodes, NoiseOfAnEmptySceneStaysNoise) {
  for (const Agc agc : {Agc::Linear, Agc::Plateau})
    for (const double sigma : {1.5, 5.0, 20.0, 80.0}) {
      const auto codes = shown(emptyScene(4000.0, sigma), lawOf(agc), sigma);
      const std::string what = print("display: noise of %g counts, %s", sigma, agc == Agc::Linear ? "linear" : "plateau");
      // Rounding of counts and of codes adds a twelfth of the square of each step: 4 codes of 1.5 counts are 2.7 a count.
      const double step = 4.0 / sigma, steps = std::sqrt(16.0 + (step * step + 1.0) / 12.0);
      figure(what + " [codes rms]", deviation(codes), steps, 0.03,
             "4 codes, steps of counts and codes; the plateau's tails have fewer codes, 1 % of the range each");
      EXPECT_NEAR(medianOf(codes), 127.5, 0.5 + step) << what;
      const auto [least, most] = std::minmax_element(codes.begin(), codes.end());
      EXPECT_GT(*least, 80.0f) << what;
      EXPECT_LT(*most, 175.0f) << what;
    }
}

// One pixel far hotter is white, and leaves all others as they are without it.
TEST(DisplayCodes, OneHotPixel) {
  for (const Agc agc : {Agc::Linear, Agc::Plateau})
    for (const double sigma : {0.0, 3.0, 12.0}) {
      std::vector<float> counts = emptyScene(4000.0, std::max(sigma, 1e-9));
      const auto without = shown(counts, lawOf(agc), std::max(sigma, 3.0));
      counts[777] = 16000.0f;
      const auto with = shown(counts, lawOf(agc), std::max(sigma, 3.0));
      EXPECT_EQ(with[777], 255.0f);
      double worst = 0.0;
      for (std::size_t k = 0; k < with.size(); ++k)
        if (k != 777) worst = std::max(worst, std::abs(static_cast<double>(with[k]) - static_cast<double>(without[k])));
      EXPECT_LE(worst, 1.0) << sigma;  // a rounding of codes: one pixel of 65536 moves the percentiles by no count, the median by 1e-5 of one
    }
}

// The converter's whole range, whatever is in it; and what is no number is white.
TEST(DisplayCodes, FixedRangeAndWhatIsNone) {
  const auto codes = shown({0.0f, 16383.0f, 8191.5f, 1638.3f}, lawOf(Agc::Fixed));
  EXPECT_EQ(codes, (std::vector<float>{0.0f, 255.0f, 127.0f, 25.0f}));
  for (const Agc agc : {Agc::Fixed, Agc::Linear, Agc::Plateau}) {
    const auto with = shown({100.0f, NAN, 101.0f, 99.0f, 100.0f}, lawOf(agc));
    EXPECT_EQ(with[1], 255.0f);
    EXPECT_TRUE(std::all_of(with.begin(), with.end(), [](float v) { return v >= 0.0f && v <= 255.0f; }));
  }
}

// Codes are for a screen as they are: pictures of frames do not stretch them again, and streams have eight bits of them.
TEST(DisplayCodes, AreShownAsTheyAre) {
  Frame frame;
  frame.camera = "c";
  frame.width = 64, frame.height = 2;
  frame.layers = {{"mw.display", "code", {}}};
  for (int k = 0; k < 128; ++k) frame.layers[0].pixels.push_back(static_cast<float>(100 + k / 16));
  PictureStyle style;
  style.plain = true;
  const Rgb8Image picture = pictureOf(frame, style);
  for (const auto& [column, code] : {std::pair{0, 100}, std::pair{40, 102}, std::pair{63, 103}})
    for (int colour = 0; colour < 3; ++colour)
      EXPECT_NEAR(static_cast<double>(picture.rgb[static_cast<std::size_t>(3 * column + colour)]), code, 1.0) << column;
  EXPECT_EQ(screenEnds(frame.layers[0]), (std::pair{0.0, 255.0}));
  EXPECT_FALSE(screenEnds({"mw.counts", "count", {}}));
  const Simulation sim = scene(
      "cameras: [{name: c, film: {width: 64, height: 2, pitch: 15 um}, focal_length: 100 mm, aperture: 25 mm, exposure: 4 ms, position: [0 m, 0 m, 0 m], "
      "heading: 0 deg, stages: [{stage: detector, full_well: 7e6}], "
      "channels: [{name: mw, response: {band: [3.5 um, 4.9 um]}, quantum_efficiency: 0.8, output: [display, counts]}]}]\n");
  StreamCoder codes(sim.cameras[0], "mw.display", {}, {}), counts(sim.cameras[0], "mw.counts", {}, {});
  EXPECT_EQ(codes.bits(), 8);
  EXPECT_EQ(counts.bits(), 14);
  frame.layers[0].pixels[5] = 255.0f;
  StreamPicture sent;
  codes.code(frame, sent);
  EXPECT_EQ(sent.codes[0], 100);
  EXPECT_EQ(sent.codes[5], 255);
  EXPECT_EQ(sent.outside, 0u);
}

// Order is kept: a hotter pixel is never darker.
TEST(DisplayCodes, KeepsTheOrder) {
  std::mt19937 random(9);
  for (int trial = 0; trial < 50; ++trial) {
    DetectorLaw law = lawOf(trial % 2 ? Agc::Plateau : Agc::Linear, trial % 3 ? 0.0 : 0.3);
    law.bits = 8 + trial % 7;
    law.display.plateau = std::pow(10.0, -3.0 * static_cast<double>(random() % 1000) / 1000.0);
    law.display.linear = static_cast<double>(random() % 101) / 100.0;
    std::vector<float> counts;
    for (int k = 0; k < 3000; ++k) counts.push_back(static_cast<float>(random() % (1u << (1 + random() % static_cast<unsigned>(law.bits)))));
    std::vector<float> sorted = counts;
    std::sort(sorted.begin(), sorted.end());
    const auto codes = shown(sorted, law, 2.0);
    ASSERT_TRUE(std::is_sorted(codes.begin(), codes.end())) << trial;
  }
}

}  // namespace
}  // namespace pitviper::test
