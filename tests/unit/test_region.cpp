// Figures of parts of a picture, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

#include "sim/frame/region.hpp"

namespace pitviper::test {
namespace {

constexpr int kWide = 12, kHigh = 9;

/// value = 2 + 3 x + 5 y: exact in floats.
FrameLayer regionRamp() {
  FrameLayer ramp{"ramp", "K", {}};
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x) ramp.pixels.push_back(static_cast<float>(2 + 3 * x + 5 * y));
  return ramp;
}

}  // namespace

TEST(Region, FiguresOfARampAreThoseOfItsSums) {
  const RegionFigures f = regionOf(regionRamp(), kWide, kHigh, {0, 0, kWide, 1}, 4);
  EXPECT_EQ(f.count, 12u);
  EXPECT_EQ(f.leftOut, 0u);
  EXPECT_DOUBLE_EQ(f.mean, 2.0 + 3.0 * 5.5);
  // Of 0..n-1: n (n + 1) / 12 with n - 1 in the denominator; rounding of a few doubles.
  EXPECT_NEAR(f.standardDeviation, 3.0 * std::sqrt(12.0 * 13.0 / 12.0), 1e-12);
  EXPECT_EQ(f.minimum, 2.0);
  EXPECT_EQ(f.maximum, 35.0);
  EXPECT_DOUBLE_EQ(f.median, 18.5);
  EXPECT_EQ(f.histogram, (std::vector<std::size_t>{3, 3, 3, 3}));
}

TEST(Region, BoxIsCutOffAtThePicturesEdgesAndMaskChooses) {
  const FrameLayer ramp = regionRamp();
  const RegionFigures corner = regionOf(ramp, kWide, kHigh, {-5, -5, 2, 2});
  EXPECT_EQ(corner.count, 4u);
  EXPECT_DOUBLE_EQ(corner.mean, 2.0 + 0.5 * 3.0 + 0.5 * 5.0);
  std::vector<float> mask(ramp.pixels.size(), 1.0f);
  mask[0] = 3.0f, mask[1] = 3.0f;
  const RegionFigures chosen = regionOf(ramp, kWide, kHigh, {0, 0, kWide, kHigh}, 8, &mask, 3.0f);
  EXPECT_EQ(chosen.count, 2u);
  EXPECT_DOUBLE_EQ(chosen.mean, 3.5);
  EXPECT_THROW(regionOf(ramp, kWide + 1, kHigh, {}), std::invalid_argument);
}

TEST(Region, PixelsThatAreNotFiniteAreLeftOutAndCounted) {
  FrameLayer ramp = regionRamp();
  ramp.pixels[0] = NAN, ramp.pixels[1] = INFINITY;
  const RegionFigures f = regionOf(ramp, kWide, kHigh, {0, 0, 3, 1});
  EXPECT_EQ(f.count, 1u);
  EXPECT_EQ(f.leftOut, 2u);
  EXPECT_EQ(f.median, 8.0);
  EXPECT_TRUE(std::isnan(f.standardDeviation));
  const RegionFigures none = regionOf(ramp, kWide, kHigh, {5, 5, 5, 9});
  EXPECT_EQ(none.count, 0u);
  EXPECT_TRUE(std::isnan(none.mean) && std::isnan(none.median) && std::isnan(none.minimum));
}

TEST(Region, DiskStandsOutOfACheckeredGroundByItsHeight) {
  constexpr int side = 41;
  FrameLayer disk{"disk", "count", {}};
  std::vector<float> mask;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const bool inside = (x - 20) * (x - 20) + (y - 20) * (y - 20) <= 100;
      mask.push_back(inside ? 1.0f : 0.0f);
      disk.pixels.push_back(inside ? 50.0f : (x + y) % 2 ? 11.0f : 9.0f);
    }
  const RegionFigures whole = regionOf(disk, side, side, {0, 0, side, side}, 8, &mask, 1.0f);
  EXPECT_EQ(whole.count, 317u);  // Gauss's circle problem: points of the lattice within 10
  EXPECT_EQ(whole.standardDeviation, 0.0);
  const RegionContrast c = contrastOf(disk, side, side, {16, 16, 25, 25}, 16);
  EXPECT_EQ(c.inside.count, 81u);
  EXPECT_EQ(c.ring.count, static_cast<std::size_t>(side * side - 81));
  const double disks = 317.0 - 81.0, n = side * side - 81.0;
  const double ground = 10.0;                                                     // of both colours, but for one pixel more of one of them
  EXPECT_NEAR(c.ring.mean, (disks * 50.0 + (n - disks) * ground) / n, 40.0 / n);  // colours in the disk are not even by some pixels
  EXPECT_DOUBLE_EQ(c.contrast, 50.0 - c.ring.mean);
  EXPECT_DOUBLE_EQ(c.signalToNoise, c.contrast / c.ring.standardDeviation);
  const RegionContrast flat = contrastOf(disk, side, side, {19, 19, 22, 22}, 2);
  EXPECT_EQ(flat.contrast, 0.0);
  EXPECT_TRUE(std::isnan(flat.signalToNoise));
}

TEST(Region, ProfileOfARampIsTheRamp) {
  const auto points = profileOf(regionRamp(), kWide, kHigh, 1.0, 1.0, 7.0, 6.5);
  ASSERT_EQ(points.size(), 10u);  // length 8.14
  EXPECT_DOUBLE_EQ(points[3].distance_px, 3.0);
  EXPECT_EQ(points.back().x, 7.0);
  EXPECT_EQ(points.back().y, 6.5);
  for (const ProfilePoint& p : points) EXPECT_NEAR(p.value, 2.0 + 3.0 * p.x + 5.0 * p.y, 1e-12);  // bilinear is exact; rounding of doubles
}

TEST(Region, ProfileHasNoValueBesidePicturesAndGapsAndReachesTheEdge) {
  FrameLayer ramp = regionRamp();
  ramp.pixels[5] = NAN;
  const auto points = profileOf(ramp, kWide, kHigh, -1.0, 0.0, 12.0, 0.0);
  ASSERT_EQ(points.size(), 14u);
  for (const ProfilePoint& p : points) EXPECT_EQ(std::isnan(p.value), p.x < 0.0 || p.x > 11.0 || p.x == 5.0) << p.x;
  EXPECT_EQ(profileOf(ramp, kWide, kHigh, 2.0, 2.0, 2.0, 2.0).size(), 1u);
  EXPECT_THROW(profileOf(ramp, kWide, kHigh, 0.0, 0.0, NAN, 0.0), std::invalid_argument);
}

}  // namespace pitviper::test
