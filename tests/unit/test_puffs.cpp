// Puffs: the closed form of their columns against quadrature, mass, what lines of sight pass, and the same formulas in single precision.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "materials/fields/puff_physics.hpp"
#include "materials/fields/puffs.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

namespace single {
using Real = float;
using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using glm::dot;
using glm::max;
using glm::min;
using std::sqrt;
/// Constants are doubles there, floats in GLSL: sums are rounded to float when they are kept, a step or two later than there.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wfloat-conversion"
#pragma GCC diagnostic ignored "-Wdouble-promotion"
inline float max(double a, double b) { return static_cast<float>(a > b ? a : b); }
inline float min(double a, double b) { return static_cast<float>(a < b ? a : b); }
inline Vec3 operator*(double s, const Vec3& v) { return static_cast<float>(s) * v; }
#define PHYSICS inline
#include "materials/fields/glsl/puff.glsl"
#undef PHYSICS
#pragma GCC diagnostic pop
}  // namespace single

glm::dvec3 randomUnit(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

Puff drawnOut(std::mt19937& random) {
  std::uniform_real_distribution<double> one(0.0, 1.0);
  Puff p;
  p.centre = {100.0 * one(random), -50.0 * one(random), 10.0};
  p.radius_m = 0.3 + 3.0 * one(random);
  p.halfLength_m = p.radius_m * (1.0 + 7.0 * one(random));
  p.axis = randomUnit(random);
  p.amount[0] = 0.1 + one(random);
  p.temperature_K = 300.0 + 500.0 * one(random);
  p.gain = one(random);
  p.sun = one(random);
  p.sunAmount = one(random);
  return p;
}

/// Density at a place, per unit of amount, as the header tells it.
double density(const Puff& p, const glm::dvec3& at) {
  const glm::dvec3 d = at - p.centre;
  const double x = glm::dot(d, p.axis), across = glm::dot(d, d) - x * x, s2 = across / (p.radius_m * p.radius_m) + x * x / (p.length_m() * p.length_m());
  return s2 < 1.0 ? kPuffNorm / (p.radius_m * p.radius_m * p.length_m()) * std::pow(1.0 - s2, 3) : 0.0;
}

// Rationale: 4 Gauss points integrate a polynomial of degree 7, the integrand has 6; quadrature of the density by 20000 steps of the trapezoidal rule, whose
// error at the ends is of the fourth order for a function with three derivatives there. Expected: equal within 1e-9 of the whole column.
TEST(Puffs, ColumnsAreThoseOfTheDensity) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> one(-1.0, 1.0);
  double worst = 0.0;
  for (int k = 0; k < 40; ++k) {
    const Puff p = drawnOut(random);
    const glm::dvec3 direction = randomUnit(random), through = p.centre + 0.7 * p.radius_m * one(random) * randomUnit(random);
    const glm::dvec3 origin = through - 9000.0 * direction;
    const double from = 9000.0 + p.length_m() * one(random), to = from + p.length_m() * (1.0 + one(random));
    constexpr int kSteps = 20000;
    double sum = 0.0;
    for (int i = 0; i <= kSteps; ++i)
      sum += (i == 0 || i == kSteps ? 0.5 : 1.0) * density(p, origin + (from + (to - from) * i / kSteps) * direction) * (to - from) / kSteps;
    const double whole = puffColumn(p, origin, direction, 0.0, 1e9);
    ASSERT_GT(whole, 0.0);
    worst = std::max(worst, std::abs(puffColumn(p, origin, direction, from, to) - sum) / whole);
  }
  bound("columns of puffs, closed form against quadrature", worst, 1e-8, "2e-5 steps of the trapezoidal rule; 9 km of origin in double");
}

// Rationale: whatever way one looks, the columns over the plane across add up to the amount. 200 x 200 even places over the bounding sphere: the integrand has
// three derivatives at its edge. Expected: 1e-4.
TEST(Puffs, HoldTheirAmountFromEverySide) {
  std::mt19937 random(2);
  double worst = 0.0;
  for (int k = 0; k < 6; ++k) {
    const Puff p = drawnOut(random);
    const glm::dvec3 look = randomUnit(random), right = glm::normalize(glm::cross(look, randomUnit(random))), up = glm::cross(look, right);
    const double reach = p.length_m();
    constexpr int kSide = 400;
    double sum = 0.0;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j)
        sum +=
            puffColumn(p, p.centre + reach * ((2.0 * (i + 0.5) / kSide - 1.0) * right + (2.0 * (j + 0.5) / kSide - 1.0) * up) - 100.0 * look, look, 0.0, 1e9);
    worst = std::max(worst, std::abs(sum * 4.0 * reach * reach / (kSide * kSide) - 1.0));
  }
  bound("amount of puffs by their columns over a plane", worst, 1e-4, "midpoint rule, 400 x 400");
}

// Rationale: parts of a line are closed forms each, so that what they add up to doesn't depend on how many there are. Expected: to rounding.
TEST(Puffs, AnyNumberOfStepsHoldsTheSame) {
  std::mt19937 random(3);
  std::vector<Puff> puffs;
  for (int k = 0; k < 30; ++k) puffs.push_back(drawnOut(random));
  const PuffsState state(puffs);
  double worst = 0.0;
  int lines = 0;
  for (int k = 0; k < 50; ++k) {
    const glm::dvec3 direction = randomUnit(random);
    const FieldLine line{puffs[static_cast<std::size_t>(k) % 30].centre + 0.2 * randomUnit(random) - 2000.0 * direction, direction, 0.0, 1e6};
    double whole = 0.0, heat = 0.0, gained = 0.0;
    for (const Puff& p : puffs) {
      const double column = p.amount[0] * puffColumn(p, line.origin, line.direction, 0.0, 1e6);
      whole += column;
      heat += column * p.temperature_K;
      gained += column * p.gain;
    }
    ASSERT_GT(whole, 0.0);
    for (int steps : {1, 2, 7, 64}) {
      std::vector<FieldStep> out;
      state.along(line, steps, out);
      ASSERT_LE(std::ranges::count_if(out, [&](const FieldStep& s) { return &s == out.data() || s.enter_m != (&s - 1)->enter_m; }), steps);
      double sum = 0.0, sumHeat = 0.0, sumGained = 0.0, last = 0.0;
      for (const FieldStep& s : out) {
        EXPECT_GE(s.enter_m, last);
        EXPECT_GT(s.leave_m, s.enter_m);
        last = s.enter_m;
        sum += s.amount[0];
        sumHeat += s.amount[0] * s.temperature_K;
        sumGained += s.amount[0] * s.gain;
      }
      worst = std::max({worst, std::abs(sum / whole - 1.0), std::abs(sumHeat / heat - 1.0), std::abs(sumGained / gained - 1.0)});
      ++lines;
    }
  }
  bound("amounts of puffs by 1 to 64 steps of " + std::to_string(lines) + " lines", worst, 1e-11, "rounding, 2 km from the origin");
}

TEST(Puffs, LinesEndWhereTheyAreTold) {
  Puff p;
  p.amount[0] = 2.0;
  const PuffsState state({p});
  std::vector<FieldStep> out;
  state.along({{-5, 0, 0}, {1, 0, 0}, 0.0, 5.0}, 8, out);  // as far as its middle
  double sum = 0.0;
  for (const FieldStep& s : out) sum += s.amount[0];
  EXPECT_NEAR(sum, kPuffNorm * 32.0 / 35.0, 1e-12);  // half of 2 x 32/35 C
  EXPECT_DOUBLE_EQ(out.back().leave_m, 5.0);
  state.along({{-5, 0, 1.001}, {1, 0, 0}, 0.0, 100.0}, 8, out);
  EXPECT_TRUE(out.empty());
  state.along({{-5, 0, 0}, {1, 0, 0}, 6.5, 100.0}, 8, out);
  EXPECT_TRUE(out.empty());
}

// Nothing lies outside what bounds it: each element's sphere, and the box.
TEST(Puffs, AreWithinTheirBounds) {
  std::mt19937 random(4);
  std::vector<Puff> puffs;
  for (int k = 0; k < 5; ++k) puffs.push_back(drawnOut(random));
  const PuffsState state(puffs);
  ASSERT_EQ(state.elements.size(), puffs.size());
  for (int k = 0; k < 4000; ++k) {
    const std::size_t own = static_cast<std::size_t>(k) % 5;
    const Puff& p = puffs[own];
    const glm::dvec3 at = p.centre + p.length_m() * std::cbrt(std::uniform_real_distribution<double>(0, 1)(random)) * randomUnit(random);
    if (density(p, at) == 0.0) continue;
    const glm::dvec3 field = at - state.origin;
    EXPECT_LE(glm::length(field - state.elements[own].centre), state.elements[own].radius_m);
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(field, state.low)) && glm::all(glm::lessThanEqual(field, state.high)));
  }
  EXPECT_EQ(state.texels->texel.size(), 4 * puffs.size());
}

// Rationale: what GLSL does. Places 10 km away have steps of 1 mm in single precision, 1/300 of this puff's radius. Expected: columns within 2 % of the
// greatest, and within 2e-6 where the line's place is near.
TEST(Puffs, SinglePrecisionKeepsThem) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> one(-1.0, 1.0);
  double nearby = 0.0, far = 0.0;
  for (int k = 0; k < 400; ++k) {
    Puff p = drawnOut(random);
    p.radius_m = 0.3;
    p.halfLength_m = 1.2;
    const glm::dvec3 direction = randomUnit(random), through = p.centre + 0.3 * one(random) * randomUnit(random);
    const double greatest = puffColumn(p, p.centre - p.axis, p.axis, -10.0, 10.0);
    for (double away : {1.0, 1e4}) {
      const glm::dvec3 place = through - away * direction;
      const float squash = static_cast<float>(p.radius_m / p.length_m() - 1.0), radius = 0.3f;
      const glm::vec3 axis(p.axis), q(place), d(direction);
      const glm::vec3 chord = single::puffChord(single::puffScaled(q - glm::vec3(p.centre), axis, squash, radius), single::puffScaled(d, axis, squash, radius));
      const double column = static_cast<double>(single::puffColumn(chord, -1e9f, 1e9f)) * kPuffNorm / (p.radius_m * p.radius_m * p.length_m());
      double& worst = away < 10.0 ? nearby : far;
      worst = std::max(worst, std::abs(column - puffColumn(p, place, direction, -1e9, 1e9)) / greatest);
    }
  }
  bound("columns of a puff of 0.3 m in single precision, line's place 1 m away", nearby, 5e-5, "places to 100 m in steps of 4e-6 m");
  bound("columns of a puff of 0.3 m in single precision, line's place 10 km away", far, 2e-2, "places in steps of 1 mm");
}

// A puff behind another, as the sun sees them, has half of its own column and all of the other's.
TEST(Puffs, ShadeEachOther) {
  std::vector<Puff> puffs(2);
  puffs[0].amount[0] = 3.0;
  puffs[1].amount[0] = 5.0;
  puffs[1].centre = {4.0, 0.0, 0.0};
  shadeTowards({1.0, 0.0, 0.0}, puffs);
  const double through = kPuffNorm * 32.0 / 35.0;
  EXPECT_NEAR(puffs[0].sunAmount, through * (0.5 * 3.0 + 5.0), 1e-12);
  EXPECT_NEAR(puffs[1].sunAmount, through * 0.5 * 5.0, 1e-12);
}

}  // namespace
}  // namespace pitviper::test
