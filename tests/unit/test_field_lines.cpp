// Lines through a pixel (sim/model/field_lines.hpp) as a rule of integration: what they stand for, and what they make of profiles whose means are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/model/field_lines.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

FieldLines ofParts(std::vector<FieldLines::Part> parts) {
  FieldLines lines{glm::dvec2(INFINITY), glm::dvec2(-INFINITY), INFINITY, std::move(parts)};
  for (const FieldLines::Part& p : lines.parts) {
    lines.low = glm::min(lines.low, p.low), lines.high = glm::max(lines.high, p.high);
    lines.apart_px = std::min({lines.apart_px, p.apart_px.x, p.apart_px.y});
  }
  return lines;
}

// Rationale: whatever parts there are, a pixel is all that its lines stand for and what is outside, each line in the pixel, no more of them than allowed.
TEST(FieldLines, StandForThePixel) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<FieldLines::Part> parts;
    for (int k = 0; k < 1 + trial % 7; ++k) {
      const glm::dvec2 low(3.0 * unit(random) - 1.5, 3.0 * unit(random) - 1.5),
          size(std::pow(10.0, 3.0 * unit(random) - 2.0), std::pow(10.0, 3.0 * unit(random) - 2.0));
      parts.push_back({low, low + size, {std::pow(10.0, 3.0 * unit(random) - 2.5), std::pow(10.0, 3.0 * unit(random) - 2.5)}, static_cast<std::size_t>(k)});
    }
    const FieldLines lines = ofParts(parts);
    for (int most : {4, 24}) {
      const PixelLines p = pixelLines({&lines, 1}, 0, 0, most, {1.0 + 2.0 * unit(random), 1 + trial % 2});
      double sum = p.outside;
      for (const FilmLine& l : p.within) {
        sum += l.share;
        EXPECT_TRUE(l.share > 0.0 && l.at.x >= 0.0 && l.at.x <= 1.0 && l.at.y >= 0.0 && l.at.y <= 1.0);
      }
      EXPECT_NEAR(sum, 1.0, 1e-9);
      EXPECT_LE(static_cast<int>(p.within.size()), most * most);
    }
  }
}

// A band with a Gaussian profile across it, anywhere over pixels and through their borders: its mean over each pixel is a difference of error functions. Lines
// as a jet asks for them: a quarter of the width apart, which is 0.35 sigma; and three times that.
TEST(FieldLines, HoldAGaussianThatABorderCuts) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double fine = 0.0, coarse = 0.0;
  for (int trial = 0; trial < 400; ++trial) {
    const double width = std::pow(10.0, 1.5 * unit(random) - 1.7), centre = 2.0 * unit(random) - 0.5;
    const FieldLines lines = ofParts({{{centre - 4.0 * width, -1.0}, {centre + 4.0 * width, 2.0}, {0.25 * width, 10.0}, 0}});
    const double want = 0.5 * std::sqrt(std::acos(-1.0)) * width * (std::erf((1.0 - centre) / width) - std::erf(-centre / width));
    for (const double coarser : {1.0, 3.0}) {
      const PixelLines p = pixelLines({&lines, 1}, 0, 0, 128, {coarser, 2});
      double sum = 0.0;
      for (const FilmLine& l : p.within) sum += l.share * std::exp(-std::pow((l.at.x - centre) / width, 2.0));
      // Of what one sends that lies wholly within the pixel.
      const double error = std::abs(sum - want) / (std::sqrt(std::acos(-1.0)) * width);
      (coarser > 1.0 ? coarse : fine) = std::max(coarser > 1.0 ? coarse : fine, error);
    }
  }
  bound("a Gaussian through a pixel's borders by its lines, of all of it", fine, 1e-4,
        "Gauss's three points on panels of 0.75 widths: f^(6) h^7 / 2016000 on two or three of them");
  bound("the same, lines three times as far apart", coarse, 1e-2,
        "panels of 2.25 widths: the same remainder 3^6 times, no longer small; pictures take them where a third of the accuracy holds");
}

}  // namespace
}  // namespace pitviper::test
