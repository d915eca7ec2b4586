// Spherical harmonics, sums of zonal ones in a plane, and grids of directions.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/model/direction_grid.hpp"
#include "sim/model/environment_map.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

/// Directions and solid angles, exact for polynomials up to degree 15.
std::vector<std::pair<glm::dvec3, double>> sphereRule() {
  std::vector<std::pair<glm::dvec3, double>> all;
  for (const QuadratureNode& q : gaussLegendre(10, -1.0, 1.0))
    for (int a = 0; a < 20; ++a) {
      const double s = std::sqrt(1.0 - q.x * q.x), phi = 2.0 * kPi * (a + 0.3) / 20;
      all.push_back({{s * std::cos(phi), s * std::sin(phi), q.x}, q.weight * 2.0 * kPi / 20});
    }
  return all;
}

TEST(Harmonics, AreOrthonormal) {
  double worst = 0.0;
  std::array<std::array<double, kMostHarmonics>, kMostHarmonics> products{};
  for (const auto& [d, weight] : sphereRule()) {
    Harmonics y;
    realHarmonics(d, kMostHarmonicOrder, y);
    for (size_t i = 0; i < y.size(); ++i)
      for (size_t j = 0; j < y.size(); ++j) products[i][j] += weight * y[i] * y[j];
  }
  for (size_t i = 0; i < products.size(); ++i)
    for (size_t j = 0; j < products.size(); ++j) worst = std::max(worst, std::abs(products[i][j] - (i == j ? 1.0 : 0.0)));
  bound("integrals of products of harmonics against 1 and 0", worst, 1e-13, "rounding");
}

// Published forms (Ramamoorthi and Hanrahan 2001, equation 3): order and signs.
TEST(Harmonics, HaveTheirNames) {
  const glm::dvec3 d = glm::normalize(glm::dvec3(0.3, -0.5, 0.7));
  Harmonics y;
  realHarmonics(d, kMostHarmonicOrder, y);
  EXPECT_NEAR(y[0], 0.282095, 1e-6);
  EXPECT_NEAR(y[1], 0.488603 * d.y, 1e-6);
  EXPECT_NEAR(y[2], 0.488603 * d.z, 1e-6);
  EXPECT_NEAR(y[3], 0.488603 * d.x, 1e-6);
  EXPECT_NEAR(y[4], 1.092548 * d.x * d.y, 1e-6);
  EXPECT_NEAR(y[6], 0.315392 * (3.0 * d.z * d.z - 1.0), 1e-6);
  EXPECT_NEAR(y[8], 0.546274 * (d.x * d.x - d.y * d.y), 1e-6);
}

// What is even about a plane, times any light, is its weighted sum over directions in that plane.
TEST(Harmonics, SumsInAPlane) {
  double worst = 0.0;
  for (int trial = 0; trial < 50; ++trial) {
    std::array<double, kPlaneWeights> even;
    Harmonics light;
    for (size_t k = 0; k < even.size(); ++k) even[k] = std::sin(1.7 * trial + 2.3 * static_cast<double>(k * k));
    for (size_t k = 0; k < light.size(); ++k) light[k] = std::cos(0.9 * trial + 1.1 * static_cast<double>(k * k));
    double whole = 0.0, inPlane = 0.0;
    const auto w = planeWeights(even);
    for (int l = 0; l <= kMostHarmonicOrder; ++l)
      for (int k = 0; k <= l; ++k) {
        whole += even[static_cast<size_t>(planeWeightAt(l, k))] * light[static_cast<size_t>(l * l + l + k)];
        Harmonics y;
        const double turn = kPi * kPlaneTurns[static_cast<size_t>(k)];
        realHarmonics({std::sin(turn), 0.0, std::cos(turn)}, kMostHarmonicOrder, y);
        double of = 0.0;
        for (int c = l * l; c < (l + 1) * (l + 1); ++c) of += light[static_cast<size_t>(c)] * y[static_cast<size_t>(c)];
        inPlane += w[static_cast<size_t>(planeWeightAt(l, k))] * of;
      }
    worst = std::max(worst, std::abs(whole - inPlane));
  }
  bound("sums over five directions of the plane against all coefficients", worst, 1e-12, "rounding");
}

TEST(DirectionGrid, ProjectsWhatItHolds) {
  for (int azimuths : {1, 24}) {
    DirectionGrid grid;
    grid.azimuths = azimuths;
    grid.horizon_rad = -0.05;
    grid.turn_rad = 0.7;
    const auto each = grid.harmonics();
    Harmonics ones{};
    double solidAngle = 0.0, worst = 0.0;
    for (const auto& h : each)
      for (size_t c = 0; c < h.size(); ++c) ones[c] += h[c];
    for (const auto& s : grid.samples(3)) solidAngle += s.solidAngle;
    for (size_t c = 1; c < ones.size(); ++c) worst = std::max(worst, std::abs(ones[c]));
    figure("harmonic 0 of light of 1", ones[0], std::sqrt(4.0 * kPi), 1e-9, "closed form");
    bound("its other harmonics", worst, 1e-7, "uniform light has none; Gauss points of a cell");
    figure("solid angle of its samples [sr]", solidAngle, 4.0 * kPi, 1e-6, "closed form");
    for (size_t g = 0; g < grid.size(); ++g) {
      // Its own entries read themselves.
      glm::dvec3 d = grid.direction(g);
      const auto r = grid.at(d);
      double own = 0.0;
      for (size_t k = 0; k < 4; ++k)
        if (grid.elevation_rad(static_cast<int>(r.at[k]) / azimuths) == grid.elevation_rad(static_cast<int>(g) / azimuths)) own += r.weight[k];
      const int ring = static_cast<int>(g) / azimuths;
      if (ring != 0 && ring != grid.above) {
        EXPECT_NEAR(own, 1.0, 1e-6) << g;
      }
    }
  }
}

// Each pixel shows one direction, all together the sphere.
TEST(EnvironmentMap, CoversTheSphereOnce) {
  for (const MapLayout layout : {MapLayout::LatitudeLongitude, MapLayout::Cube}) {
    constexpr int kWidth = 600, kHeight = 200;
    double solidAngle = 0.0;
    glm::dmat3 second(0.0);
    glm::dvec3 first(0.0);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const double across = (x + 0.5) / kWidth, down = (y + 0.5) / kHeight, weight = mapSolidAngle(layout, across, down) / (kWidth * kHeight);
        const glm::dvec3 d = mapDirection(layout, across, down, 0.4);
        EXPECT_NEAR(glm::length(d), 1.0, 1e-12);
        solidAngle += weight;
        first += weight * d;
        for (int i = 0; i < 3; ++i) second[i] += weight * d[i] * d;
      }
    figure("solid angle of a map's pixels [sr]", solidAngle, 4.0 * kPi, 1e-3, "closed form; middles of pixels");
    EXPECT_LT(glm::length(first), 1e-3);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(second[i][j], i == j ? 4.0 * kPi / 3.0 : 0.0, 2e-3);
  }
  // The middle looks where it is headed: east at 90 deg; the right half is clockwise of that.
  const glm::dvec3 middle = mapDirection(MapLayout::LatitudeLongitude, 0.5, 0.5, 0.5 * kPi),
                   right = mapDirection(MapLayout::LatitudeLongitude, 0.75, 0.5, 0.5 * kPi), up = mapDirection(MapLayout::Cube, 4.5 / 6.0, 0.5, 0.0),
                   aside = mapDirection(MapLayout::Cube, 1.5 / 6.0, 0.5, 0.0);
  EXPECT_NEAR(middle.x, 1.0, 1e-12);
  EXPECT_NEAR(right.y, -1.0, 1e-12);
  EXPECT_NEAR(up.z, 1.0, 1e-12);
  EXPECT_NEAR(aside.x, 1.0, 1e-12);
}

}  // namespace
}  // namespace pitviper::test
