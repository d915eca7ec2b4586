// Lines through a pixel (sim/world/field_lines.hpp) as a rule of integration: what they stand for, and what they make of profiles whose means are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "sim/world/field_lines.hpp"
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
      const PixelLines p = pixelLines(std::array{&lines}, 0, 0, most, {1.0 + 2.0 * unit(random), 1 + trial % 2});
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
      const PixelLines p = pixelLines(std::array{&lines}, 0, 0, 128, {coarser, 2});
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

// Rationale: parts as fine as 1e-6 of a pixel beside coarse ones, all over it, would be halved into 1e12 cells. Expected: as many lines as allowed at most, at
// once, that stand for the whole pixel.
TEST(FieldLines, StayFewHoweverFineThePartsAre) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<FieldLines::Part> parts;
    const double fine = std::pow(10.0, -6.0 * unit(random));
    for (int k = 0; k < 2 + trial % 5; ++k) {
      const double apart = k == 0 ? fine : std::pow(10.0, -6.0 * unit(random)), thin = trial % 3 == 0 ? 1.0 : 1e-3 * unit(random);
      parts.push_back({{-1.0, thin < 1.0 ? unit(random) : -1.0}, {2.0, 2.0}, {apart, trial % 2 ? apart : 1e-6}, static_cast<std::size_t>(k)});
    }
    const FieldLines lines = ofParts(parts);
    for (int most : {1, 4, 48, 128}) {
      const PixelLines p = pixelLines(std::array{&lines}, 0, 0, most, {1.0, 2});
      double sum = p.outside;
      for (const FilmLine& l : p.within) sum += l.share;
      EXPECT_NEAR(sum, 1.0, 1e-9);
      EXPECT_LE(static_cast<int>(p.within.size()), most * most);
    }
  }
}

/// A field of one sphere without a box of its own.
struct Sphere final : FieldState {
  Sphere(const glm::dvec3& centre, double radius_m) {
    FieldElement e;
    e.centre = centre, e.radius_m = radius_m, e.finest_m = 0.1 * radius_m;
    elements = {e};
    low = centre - radius_m, high = centre + radius_m;
  }
  void along(const FieldLine&, int, std::vector<FieldStep>&) const override {}
};

View aView(double field_deg) {
  View v;
  v.width = 24, v.height = 16;
  v.tanPerPixelX = v.tanPerPixelY = 2.0 * std::tan(0.5 * field_deg * std::acos(-1.0) / 180.0) / v.width;
  v.axisX = 12.0, v.axisY = 8.0;
  return v;
}

// Expected: what is beside, above, below or behind the film shows nowhere, however far off; and wherever a place of a sphere falls on the film, it is within
// the rectangle that it is looked for in. Angles as far as 178 degrees across, spheres from inside of which one looks to such of 1e-6 rad.
TEST(FieldLines, ASphereShowsWhereItIs) {
  for (const double far_m : {10.0, 1e3, 1e4, 1e5, 1e7})
    for (const glm::dvec3& way :
         {glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0), glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0.6, 0.8, 0.0)})
      EXPECT_TRUE(fieldLines(aView(6.0), Sphere(far_m * way, 3.0)).isEmpty()) << far_m;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> normal;
  int shown = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const View v = aView(trial % 4 == 0 ? 178.0 : 2.0 + 170.0 * unit(random));
    const double distance = std::pow(10.0, 5.0 * unit(random)), radius = distance * std::pow(10.0, -6.0 * unit(random) + 0.5);
    glm::dvec3 way(normal(random), normal(random), trial % 2 ? 0.02 * normal(random) : normal(random));
    const glm::dvec3 centre = distance * glm::normalize(way);
    const Sphere sphere(centre, radius);
    const FieldLines lines = fieldLines(v, sphere);
    for (int k = 0; k < 200; ++k) {
      const glm::dvec3 p = centre + radius * glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
      if (p.z >= -1e-9 * distance) continue;
      const glm::dvec2 at = filmPosition(v, p);
      if (at.x < 0.0 || at.y < 0.0 || at.x > v.width || at.y > v.height) continue;
      ++shown;
      ASSERT_FALSE(lines.parts.empty());
      const FieldLines::Part& part = lines.parts.front();
      ASSERT_TRUE(at.x >= part.low.x - 1e-6 && at.x <= part.high.x + 1e-6 && at.y >= part.low.y - 1e-6 && at.y <= part.high.y + 1e-6)
          << at.x << " " << at.y << " in " << part.low.x << " " << part.low.y << " to " << part.high.x << " " << part.high.y;
    }
  }
  EXPECT_GT(shown, 10000);
}

}  // namespace
}  // namespace pitviper::test
