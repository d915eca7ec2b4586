// Curves that a hand draws: monotone cubics keep within their points, points keep within their bounds, what is written is read again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scenarios/reader/yaml_tree.hpp"
#include "scenarios/view/edited_curve.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/spectrum_value.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

/// Numbers are kept to twelve digits.
constexpr double kDigits = 1e-12;

/// The data RPN 14 on which F. N. Fritsch and R. E. Carlson, SIAM J. Numer. Anal. 17, 238 (1980) show that splines overshoot and theirs does not.
EditedCurve rpn14(bool smooth) {
  return EditedCurve({{7.99, 0.0},
                      {8.09, 2.76429e-5},
                      {8.19, 4.37498e-2},
                      {8.7, 0.169183},
                      {9.2, 0.469428},
                      {10.0, 0.943740},
                      {12.0, 0.998636},
                      {15.0, 0.999919},
                      {20.0, 0.999994}},
                     smooth);
}

TEST(EditedCurve, RisesWherePublishedDataRises) {
  const EditedCurve curve = rpn14(true);
  EXPECT_EQ(curve.table().value.size(), 8u * EditedCurve::kPieces + 1u);
  EXPECT_TRUE(std::is_sorted(curve.table().value.begin(), curve.table().value.end()));
  for (const CurvePoint& p : curve.points()) EXPECT_NEAR(curve.at(p.wavelength_um), p.value, kDigits);
  // It is no polyline.
  EXPECT_GT(std::abs(curve.at(9.6) - rpn14(false).at(9.6)), 0.005);
}

TEST(EditedCurve, NeverLeavesItsPoints) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    std::vector<CurvePoint> points;
    double w = 0.2;
    for (int i = 0; i < 12; ++i) points.push_back({w += 0.01 + any(random), any(random) < 0.3 ? 0.0 : any(random)});
    const EditedCurve curve(points, true);
    points = curve.points();
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      for (double u = 0.0; u <= 1.0; u += 0.02) {
        const double v = curve.at(std::lerp(points[i].wavelength_um, points[i + 1].wavelength_um, u));
        EXPECT_GE(v, std::min(points[i].value, points[i + 1].value) - kDigits);
        EXPECT_LE(v, std::max(points[i].value, points[i + 1].value) + kDigits);
      }
  }
}

TEST(EditedCurve, SmoothIsExactForLinesAndParabolas) {
  std::vector<CurvePoint> line, parabola;
  for (double w : {1.0, 1.7, 2.0, 3.5, 5.0}) line.push_back({w, 0.1 + 0.13 * w}), parabola.push_back({w, 0.03 * w * w});
  const EditedCurve straight(line, true), bent(parabola, true);
  double worst = 0.0, worstBent = 0.0;
  for (double w : straight.table().wavelength_um) {
    worst = std::max(worst, std::abs(straight.at(w) - 0.1 - 0.13 * w));
    // Slopes by three points are those of a parabola, but for the ends.
    if (w >= 1.7 && w <= 3.5) worstBent = std::max(worstBent, std::abs(bent.at(w) - 0.03 * w * w));
  }
  bound("monotone cubic through a straight line, off by", worst, kDigits, "exact but for twelve digits");
  bound("monotone cubic through a parabola, between inner points, off by", worstBent, kDigits, "exact but for twelve digits");
}

TEST(EditedCurve, PointsStayInBounds) {
  EditedCurve curve({{1.0, 0.2}, {2.0, 0.5}, {3.0, 0.2}});
  curve.move(1, 2.5, -0.7);
  EXPECT_EQ(curve.points()[1], (CurvePoint{2.5, 0.0}));
  curve.move(1, 2.5, 7.0);
  EXPECT_EQ(curve.points()[1].value, 1.0);
  // Not past its neighbours, nor onto them.
  curve.move(1, 9.0, 0.5);
  EXPECT_LT(curve.points()[1].wavelength_um, 3.0);
  EXPECT_NEAR(curve.points()[1].wavelength_um, 3.0, 3.0 * 1.01 * EditedCurve::kMargin);
  curve.move(1, 0.2, 0.5);
  EXPECT_GT(curve.points()[1].wavelength_um, 1.0);
  curve.move(0, 0.001, 0.5);
  EXPECT_EQ(curve.points()[0].wavelength_um, kShortestWavelength_um);
  curve.move(2, 1e9, 0.5);
  EXPECT_EQ(curve.points()[2].wavelength_um, kLongestWavelength_um);
  // Held outside; a point upon another is that one.
  EXPECT_EQ(EditedCurve({{1.0, 0.25}}).at(17.0), 0.25);
  EXPECT_EQ(curve.add(5.0, 0.4), 2u);
  EXPECT_EQ(curve.add(5.0, 0.6), 2u);
  EXPECT_EQ(curve.points().size(), 4u);
  EXPECT_EQ(curve.at(5.0), 0.6);
  EXPECT_EQ(curve.nearest(5.4), 2u);
  for (int k = 0; k < 9; ++k) curve.remove(0);
  EXPECT_EQ(curve.points().size(), 1u);
}

TEST(EditedCurve, RefusesWhatIsNoCurve) {
  EXPECT_THROW(EditedCurve({}), std::invalid_argument);
  EXPECT_THROW(EditedCurve({{2.0, 0.1}, {1.0, 0.1}}), std::invalid_argument);
  EXPECT_THROW(EditedCurve({{0.01, 0.1}}), std::invalid_argument);
  EditedCurve curve({{1.0, 0.1}});
  EXPECT_THROW(curve.move(0, NAN, 0.1), std::invalid_argument);
  EXPECT_THROW(curve.add(1.0, INFINITY), std::invalid_argument);
  EXPECT_EQ(curve, EditedCurve({{1.0, 0.1}}));
  std::vector<CurvePoint> many;
  for (std::size_t k = 0; k <= EditedCurve::kMost; ++k) many.push_back({1.0 + 0.001 * static_cast<double>(k), 0.0});
  EXPECT_THROW(EditedCurve{many}, UserError);
  many.pop_back();
  EditedCurve full(many);
  EXPECT_THROW(full.add(0.5, 0.0), UserError);
}

// 1e-9 was asked for; twelve digits are written.
TEST(EditedCurve, IsReadAsItWasWritten) {
  const SpectrumReader reader{SpectrumFiles{}};
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  double worst = 0.0;
  for (int k = 0; k < 40; ++k) {
    std::vector<CurvePoint> points;
    double w = 0.3;
    for (int i = 0; i < 1 + k / 2; ++i) points.push_back({w += 0.001 + any(random) / 3.0, any(random)});
    const EditedCurve curve(points, k % 2);
    const Value tree = parseYaml("a: " + curve.yaml() + "\n", "curve");
    const Spectrum read = reader.read(*tree.find("a"), "", "a");
    EXPECT_EQ(read.validHigh(), kLongestWavelength_um);
    for (double u = 0.1; u < 12.0; u += 0.0317) worst = std::max(worst, std::abs(read(u) - curve.at(u)));
  }
  bound("a curve read again, off by", worst, 1e-9, "asked for; twelve digits are written");
}

TEST(EditedCurve, FollowsASpectrumByFewPoints) {
  const auto line = EditedCurve::of(Spectrum(Spectrum::Table{{1, 2, 3, 4}, {0.1, 0.2, 0.3, 0.4}, Outside::Error, ""}), 1, 4, 1e-9);
  EXPECT_EQ(line.points(), (std::vector<CurvePoint>{{1, 0.1}, {4, 0.4}}));
  // Of a bend of 0.01, and of one of 0.2.
  const Spectrum bends(Spectrum::Table{{1, 2, 3, 4, 5}, {0.1, 0.11, 0.1, 0.3, 0.1}, Outside::Error, ""});
  EXPECT_EQ(EditedCurve::of(bends, 1, 5, 0.02).points(), (std::vector<CurvePoint>{{1, 0.1}, {3, 0.1}, {4, 0.3}, {5, 0.1}}));
  EXPECT_EQ(EditedCurve::of(bends, 1, 5, 0.005).points().size(), 5u);
  // A step within the range, a part of a table, and what bends between its knots.
  const auto step = EditedCurve::of(Spectrum::band(2.0, 3.0, 0.7), 1, 4, 1e-3);
  EXPECT_EQ(step.points().size(), 6u);
  EXPECT_NEAR(step.at(1.99), 0.0, 1e-9);
  EXPECT_NEAR(step.at(2.01), 0.7, 1e-9);
  EXPECT_NEAR(EditedCurve::of(bends, 3.5, 4.5, 1e-3).at(1.0), 0.2, kDigits);
  const Spectrum product = bends * Spectrum(Spectrum::Table{{1, 5}, {0.0, 1.0}, Outside::Error, ""}), black(Spectrum::BlackBody{3000.0, 1e-6});
  for (const Spectrum* s : {&product, &black}) {
    const double tolerance = 1e-3 * s->maximum(1.0, 5.0);
    const auto curve = EditedCurve::of(*s, 1, 5, tolerance, {0.0, 100.0});
    double worst = 0.0;
    for (double w = 1.0; w <= 5.0; w += 0.003) worst = std::max(worst, std::abs(curve.at(w) - (*s)(w)));
    EXPECT_LE(worst, 1.05 * tolerance);  // the grid between knots is off by a twentieth of it
    EXPECT_LE(curve.points().size(), 60u);
  }
}

}  // namespace
}  // namespace pitviper::test
