// Numbers over time: what they are between rows and outside, their extremes, and what is refused of rows.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/parameters/time_course.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

using Between = TimeCourse::Interpolation;
using Outside = TimeCourse::Outside;

Value scalar(const std::string& text, int line = 1, int column = 1) {
  Value v;
  v.kind = Value::Kind::Scalar;
  v.text = text;
  v.where = {"t.yaml", line, column, -1};
  return v;
}

/// Rows as a user writes them, the k-th on line k + 1: time in column 3, value in column 9.
Value rows(const std::vector<std::pair<std::string, std::string>>& all) {
  Value list;
  list.kind = Value::Kind::List;
  list.where = {"t.yaml", 1, 1, -1};
  for (size_t k = 0; k < all.size(); ++k) {
    Value row;
    row.kind = Value::Kind::List;
    row.where = {"t.yaml", static_cast<int>(k) + 1, 2, -1};
    row.items = {scalar(all[k].first, static_cast<int>(k) + 1, 3), scalar(all[k].second, static_cast<int>(k) + 1, 9)};
    list.items.push_back(row);
  }
  return list;
}

Value withKeys(const Value& over, const std::vector<std::pair<std::string, std::string>>& keys) {
  Value map;
  map.kind = Value::Kind::Map;
  map.where = over.where;
  map.entries.emplace_back("over", over);
  for (const auto& [key, text] : keys) map.entries.emplace_back(key, scalar(text, 20, 5));
  map.keyPlaces.assign(map.entries.size(), over.where);
  return map;
}

TEST(TimeCourse, StraightStepsAndOutside) {
  const std::vector<TimeCourse::Point> points = {{1.0, 10.0}, {2.0, 20.0}, {4.0, 0.0}};
  const TimeCourse linear(points), steps(points, Between::Steps), zero(points, Between::Linear, Outside::Zero), loop(points, Between::Linear, Outside::Loop);
  EXPECT_EQ(linear.at(1.5), 15.0);
  EXPECT_EQ(linear.at(3.0), 10.0);
  EXPECT_EQ(linear.at(0.0), 10.0);
  EXPECT_EQ(linear.at(9.0), 0.0);
  EXPECT_EQ(linear.slopeAt(3.0), -10.0);
  EXPECT_EQ(steps.at(1.999), 10.0);
  EXPECT_EQ(steps.at(2.0), 20.0);
  EXPECT_EQ(steps.at(4.0), 0.0);
  EXPECT_EQ(zero.at(0.999), 0.0);
  EXPECT_EQ(zero.at(1.0), 10.0);
  EXPECT_EQ(zero.at(4.001), 0.0);
  EXPECT_EQ(loop.at(1.5 + 3.0), 15.0);
  EXPECT_EQ(loop.at(1.5 - 6.0), 15.0);
  EXPECT_TRUE(TimeCourse(7.0).isConstant());
  EXPECT_EQ(TimeCourse(7.0).at(-1e6), 7.0);
  EXPECT_EQ(linear.scaled(2.0).at(1.5), 30.0);
  EXPECT_EQ(linear.later(1.0).at(2.5), 15.0);
  EXPECT_THROW(TimeCourse(std::vector<TimeCourse::Point>{}), std::invalid_argument);
  EXPECT_THROW(TimeCourse({{1.0, 0.0}, {1.0, 1.0}}), std::invalid_argument);
  EXPECT_THROW(TimeCourse({{1.0, NAN}}), std::invalid_argument);
}

// Rationale: a smooth course goes through its rows with one slope on both sides of each, and never beyond the values of the rows beside it (a temperature
// stays above 0); of rows on a straight line it is that line.
TEST(TimeCourse, SmoothIsSmoothAndStaysWithinItsRows) {
  std::mt19937 random(3);
  std::uniform_real_distribution<> value(0.0, 100.0), step(0.05, 3.0);
  for (int n = 0; n < 50; ++n) {
    std::vector<TimeCourse::Point> points;
    double t = -2.0;
    for (int k = 0; k < 8; ++k) points.push_back({t += step(random), value(random)});
    const TimeCourse c(points, Between::Smooth);
    for (size_t k = 0; k + 1 < points.size(); ++k) {
      const double low = std::min(points[k].value, points[k + 1].value), high = std::max(points[k].value, points[k + 1].value);
      for (int i = 0; i <= 50; ++i) {
        const double at = points[k].time_s + (points[k + 1].time_s - points[k].time_s) * i / 50.0, v = c.at(at);
        EXPECT_GE(v, low - 1e-9);  // the last may round into the next leg
        EXPECT_LE(v, high + 1e-9);
      }
      // 1e-6 of a leg apart; slopes of at most 100/0.05 bend by at most some 1e5 /s2: 0.1 of them in 2e-6 s.
      const double h = 1e-6, before = (c.at(points[k].time_s) - c.at(points[k].time_s - h)) / h,
                   after = (c.at(points[k].time_s + h) - c.at(points[k].time_s)) / h;
      if (k > 0) {
        EXPECT_NEAR(before, after, 0.3);
      }
      const double middle = 0.5 * (points[k].time_s + points[k + 1].time_s);
      EXPECT_NEAR(c.slopeAt(middle), (c.at(middle + h) - c.at(middle - h)) / (2.0 * h), 1e-3);  // rounding of 100 over 2e-6
    }
  }
  const TimeCourse line({{0.0, 1.0}, {1.0, 3.0}, {4.0, 9.0}}, Between::Smooth);
  for (double t : {0.2, 0.9, 2.7}) EXPECT_NEAR(line.at(t), 1.0 + 2.0 * t, 1e-14);
}

// Rationale: plans take their ranges from here; against the least and greatest of many samples within the window.
TEST(TimeCourse, RangesHoldAllThatIsMet) {
  std::mt19937 random(9);
  std::uniform_real_distribution<> value(-50.0, 100.0), step(0.1, 2.0), place(-12.0, 20.0);
  for (Between between : {Between::Linear, Between::Smooth, Between::Steps})
    for (Outside outside : {Outside::Hold, Outside::Zero, Outside::Loop})
      for (int n = 0; n < 60; ++n) {
        std::vector<TimeCourse::Point> points;
        double t = 0.0;
        for (int k = 0; k < 5; ++k) points.push_back({t += step(random), value(random)});
        const TimeCourse c(points, between, outside);
        double from = place(random), to = place(random);
        if (from > to) std::swap(from, to);
        const auto [low, high] = c.range(from, to);
        double least = INFINITY, greatest = -INFINITY;
        for (int i = 0; i <= 5000; ++i) {
          const double v = c.at(from + (to - from) * i / 5000.0);
          least = std::min(least, v), greatest = std::max(greatest, v);
        }
        // Rounding of times within a loop, where slopes are up to 1500 a second.
        EXPECT_LE(low, least + 1e-9);
        EXPECT_GE(high, greatest - 1e-9);
        // Not wider than what is met: between samples values change by at most slope x spacing; a loop's jump is met on either side.
        if (between == Between::Linear && outside == Outside::Hold) {
          const double most = 1500.0 * (to - from) / 5000.0;
          EXPECT_GE(low, least - most);
          EXPECT_LE(high, greatest + most);
        }
      }
}

TEST(TimeCourse, ReadsNumbersRowsAndMaps) {
  EXPECT_EQ(readCourse(scalar("27 degC"), "K", "temperature").at(5.0), 300.15);
  const Value r = rows({{"0 s", "300 K"}, {"500 ms", "27 degC"}, {"2 s", "800 K"}});
  EXPECT_TRUE(isCourse(r));
  EXPECT_FALSE(isCourse(scalar("3 K")));
  EXPECT_EQ(readCourse(r, "K", "temperature").at(0.5), 300.15);
  EXPECT_EQ(readCourse(r, "K", "temperature").at(9.0), 800.0);
  EXPECT_EQ(readCourse(r, "K", "temperature", 0, 1e5, Outside::Zero).at(9.0), 0.0);
  const Value map = withKeys(r, {{"interpolation", "steps"}, {"outside", "loop"}});
  EXPECT_TRUE(isCourse(map));
  const TimeCourse c = readCourse(map, "K", "temperature");
  EXPECT_EQ(c.interpolation(), Between::Steps);
  EXPECT_EQ(c.at(2.25), 300.0);
  EXPECT_EQ(readCourse(withKeys(r, {{"interpolation", "smooth"}}), "K", "temperature").interpolation(), Between::Smooth);
}

TEST(TimeCourse, RefusesAtTheRow) {
  const auto refused = [](const Value& v, double low = -INFINITY, double high = INFINITY) {
    try {
      readCourse(v, "K", "temperature", low, high);
    } catch (const UserError& e) {
      return std::string(e.what());
    }
    return std::string("taken");
  };
  const auto says = [](const std::string& message, const std::string& place, const std::string& what) {
    EXPECT_EQ(message.rfind(place, 0), 0u) << message;
    EXPECT_NE(message.find(what), std::string::npos) << message;
    EXPECT_NE(message.find("; fix: "), std::string::npos) << message;
  };
  says(refused(rows({{"0 s", "300 K"}, {"2 s", "400 K"}, {"1 s", "500 K"}})), "t.yaml:3:3:", "do not rise");
  says(refused(rows({{"0 s", "300 K"}, {"0 s", "400 K"}})), "t.yaml:2:3:", "do not rise");
  says(refused(rows({{"0 m", "300 K"}})), "t.yaml:1:3:", "wrong unit");
  says(refused(rows({{"0 s", "300 W"}})), "t.yaml:1:9:", "wrong unit");
  says(refused(rows({{"0", "300 K"}})), "t.yaml:1:3:", "no unit");
  says(refused(rows({{"0 s", "300 K"}, {"1 s", "-4 K"}}), 0.0, 1e5), "t.yaml:2:9:", "out of range");
  says(refused(rows({})), "t.yaml:1:1:", "0 rows");
  says(refused(withKeys(rows({{"0 s", "300 K"}, {"1 s", "4 K"}}), {{"interpolation", "cubic"}})), "t.yaml:20:5:", "cubic");
  says(refused(withKeys(rows({{"0 s", "300 K"}}), {{"outside", "loop"}})), "t.yaml:1:1:", "one row");
  Value odd = rows({{"0 s", "300 K"}});
  odd.items[0].items.pop_back();
  says(refused(odd), "t.yaml:1:2:", "not a row");
}

}  // namespace
}  // namespace pitviper::test
