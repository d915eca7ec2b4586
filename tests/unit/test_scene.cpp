// Geodesy, motion, cameras and lights.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/scene.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0;

TEST(Geodesy, RoundTripsAndKnownPoints) {
  const LocalFrame equator({0.0, 0.0, 0.0});
  EXPECT_NEAR(equator.toEcef({0, 0, 0}).x, 6378137.0, 1e-6);
  EXPECT_NEAR(equator.toEcef({1000, 0, 0}).y, 1000.0, 1e-6);  // east is +y there
  EXPECT_NEAR(equator.toEcef({0, 1000, 0}).z, 1000.0, 1e-6);  // north is +z
  const LocalFrame pole({90 * kDegree, 0.0, 10.0});
  EXPECT_NEAR(pole.toEcef({0, 0, 0}).z, 6356752.314245 + 10.0, 1e-5);
  for (double lon : {-180.0, -179.9999, 0.0, 179.9999}) {
    const LocalFrame frame({-33.9 * kDegree, lon * kDegree, 120.0});
    const glm::dvec3 p(12345.6, -7890.1, 3210.9);
    EXPECT_LT(glm::length(frame.toLocal(frame.toGeodetic(p)) - p), 1e-6) << lon;
  }
}

TEST(Motion, AttitudesAreTheAviatorsOwn) {
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0);
  EXPECT_LT(glm::length(orientationFrom({0, 0, 0}) * x - glm::dvec3(0, 1, 0)), 1e-12) << "heading 0 is north";
  EXPECT_LT(glm::length(orientationFrom({90 * kDegree, 0, 0}) * x - glm::dvec3(1, 0, 0)), 1e-12) << "heading 90 is east";
  EXPECT_NEAR((orientationFrom({0, 30 * kDegree, 0}) * x).z, 0.5, 1e-12) << "pitch lifts the nose";
  EXPECT_NEAR((orientationFrom({0, 0, 30 * kDegree}) * y).z, 0.5, 1e-12) << "roll lifts the left wing";
}

TEST(Motion, SmoothPathsPassTheirPointsWithContinuousVelocity) {
  const Motion m({{0.0, {0, 0, 0}, {}, 0}, {1.0, {100, 10, 0}, {}, 0}, {3.0, {300, -40, 20}, {}, 0}}, Motion::Interpolation::Smooth);
  EXPECT_LT(glm::length(m.at(1.0).position - glm::dvec3(100, 10, 0)), 1e-9);
  const glm::dvec3 before = (m.at(1.0).position - m.at(1.0 - 1e-5).position) / 1e-5, after = (m.at(1.0 + 1e-5).position - m.at(1.0).position) / 1e-5;
  EXPECT_LT(glm::length(before - after), 1e-2);
  EXPECT_LT(glm::length(m.at(9.0).position - glm::dvec3(300, -40, 20)), 1e-12);
}

TEST(Motion, ABodyThatStandsKeepsItsHeading) {
  const Motion m({{0.0, {0, 0, 0}, {}, 0}, {4.0, {0, 400, 0}, {}, 0}, {8.0, {0, 400, 0}, {}, 0}, {12.0, {0, 800, 0}, {}, 0}}, Motion::Interpolation::Linear);
  for (double t : {1.0, 5.0, 7.0, 9.0, 99.0}) EXPECT_LT(glm::length(m.at(t).orientation * glm::dvec3(1, 0, 0) - glm::dvec3(0, 1, 0)), 1e-9) << t;
}

TEST(Camera, PixelSolidAnglesAreTheRectangles) {
  Pinhole p{4, 4, 1.0, 1.0, 1.0, 0.1};  // 127 degrees in 4 pixels: as coarse as it gets
  double total = 0.0;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) total += p.solidAngle_sr(column, row);
  const double half = std::atan(2.0);
  figure("4 x 4 pixels over 127 deg, solid angle [sr]", total, 4.0 * std::asin(std::sin(half) * std::sin(half)), 2e-2, "3x3 Gauss points in a pixel of 45 deg");
  Pinhole fine{200, 200, 1.0, 0.02, 0.02, 0.1};
  total = 0.0;
  for (double w : fine.solidAngles().plain_sr) total += w;
  figure("200 x 200 pixels over 127 deg, solid angle [sr]", total, 4.0 * std::asin(std::sin(half) * std::sin(half)), 1e-9, "rectangle's closed form");
}

TEST(Light, LevelsAreDarkOutside) {
  PointLight l;
  l.level = TimeCourse({{1.0, 0.0}, {2.0, 4.0}}, TimeCourse::Interpolation::Linear, TimeCourse::Outside::Zero);
  EXPECT_EQ(l.levelAt(0.9), 0.0);
  EXPECT_EQ(l.levelAt(1.5), 2.0);
  EXPECT_EQ(l.levelAt(2.1), 0.0);
}

}  // namespace
}  // namespace pitviper::test
