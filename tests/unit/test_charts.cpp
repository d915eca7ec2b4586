// Charts: a file appears, it is a picture, and curves and bars are where their numbers put them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "scenarios/commands/charts.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/module_on_demand.hpp"
#include "tests/support/read_png.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

bool isNear(Rgb8 a, Rgb8 b) { return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) < 60; }

constexpr Rgb8 kFirst{0, 114, 178}, kSecond{213, 94, 0};  // the first two series

class Charts : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(fs::path(PITVIPER_BUILD_DIR) / "libpitviper_charts.so")) GTEST_SKIP() << "built without VTK";
    folder_ = fs::temp_directory_path() / ("pitviper_charts_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }
  Rgb8Image drawn(const std::vector<Chart>& charts, int columns) const {
    drawCharts(charts, columns, folder_ / "chart.png");
    return test::readPng(folder_ / "chart.png");
  }
  fs::path folder_;
};

/// Mean row of a colour in a column below the header, or -1.
double rowOf(const Rgb8Image& p, int column, Rgb8 colour) {
  double sum = 0.0;
  int count = 0;
  for (int y = 66; y < p.height; ++y)
    if (isNear(p.at(column, y), colour)) sum += y, ++count;
  return count > 0 ? sum / count : -1.0;
}

TEST_F(Charts, CurvesAreWhereTheirNumbersPutThem) {
  Chart c{"Speed", "overdraw", "frames/s", false, false, false, {}, {}, {}};
  c.series = {{"falls", {0, 1, 2, 3, 4}, {4, 3, 2, 1, 0}, false, false}, {"rises", {0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}, false, false}};
  const Rgb8Image p = drawn({c}, 1);
  EXPECT_GT(p.width, 400);
  EXPECT_GT(p.height, 300);
  EXPECT_EQ(p.at(0, 0), (Rgb8{255, 255, 255}));
  std::set<std::uint32_t> colours;
  for (size_t i = 0; i < p.rgb.size(); i += 3) colours.insert(p.rgb[i] << 16u | p.rgb[i + 1] << 8u | p.rgb[i + 2]);
  EXPECT_GT(colours.size(), 20u);
  // Left and right ends of the curves, then the crossing: half way, where the curves are at equal height.
  int left = p.width, right = 0;
  for (int x = 0; x < p.width; ++x)
    if (rowOf(p, x, kFirst) >= 0.0) left = std::min(left, x), right = std::max(right, x);
  ASSERT_GT(right - left, p.width / 2);
  const int quarter = left + (right - left) / 4, threeQuarters = right - (right - left) / 4;
  EXPECT_LT(rowOf(p, quarter, kFirst), rowOf(p, quarter, kSecond));
  EXPECT_GT(rowOf(p, threeQuarters, kFirst), rowOf(p, threeQuarters, kSecond));
  EXPECT_NEAR(rowOf(p, quarter, kFirst), rowOf(p, threeQuarters, kSecond), 5.0);
  // A straight line: at a quarter of the way a quarter of the fall.
  const double high = rowOf(p, left + 8, kFirst), low = rowOf(p, right - 8, kFirst);
  EXPECT_NEAR(rowOf(p, quarter, kFirst), high + 0.25 * (low - high), 0.02 * (low - high) + 2.0);
}

TEST_F(Charts, APowerLawIsStraightOnLogarithmicAxes) {
  Chart c{"Power", "wavelengths", "Mpixel/s", true, true, false, {}, {4, 16, 64, 256}, {}};
  c.series = {{"", {4, 16, 64, 256}, {100, 25, 6.25, 1.5625}, false, false}};
  const Rgb8Image p = drawn({c}, 1);
  int left = p.width, right = 0;
  for (int x = 0; x < p.width; ++x)
    if (rowOf(p, x, kFirst) >= 0.0) left = std::min(left, x), right = std::max(right, x);
  const double a = rowOf(p, left + 10, kFirst), b = rowOf(p, (left + right) / 2, kFirst), d = rowOf(p, right - 10, kFirst);
  EXPECT_LT(a, d);
  EXPECT_NEAR(b, 0.5 * (a + d), 3.0);
}

TEST_F(Charts, BarsAreAsHighAsTheirNumbers) {
  Chart c{"Modes", "", "Mpixel/s", false, false, false, {}, {}, {"direct", "buffered"}};
  c.series = {{"", {0, 1}, {8, 4}, false, true}};
  const Rgb8Image p = drawn({c}, 1);
  std::vector<int> heights;  // of each run of columns that has the colour
  int previous = 0;
  for (int x = 0; x < p.width; ++x) {
    int height = 0;
    for (int y = 40; y < p.height; ++y) height += isNear(p.at(x, y), kFirst);
    if (height > 0 && previous == 0) heights.push_back(0);
    if (height > 0) heights.back() = std::max(heights.back(), height);
    previous = height;
  }
  ASSERT_EQ(heights.size(), 2u);
  EXPECT_NEAR(heights[0], 2.0 * heights[1], 4.0);
}

TEST_F(Charts, NothingSensibleToDrawIsNoCrash) {
  Chart c{"Nothing", "x", "y", true, true, false, {}, {}, {}};
  c.series = {{"empty", {}, {}, false, false}, {"bad", {-1, 0, NAN, 1}, {1, 1, 1, INFINITY}, true, false}};
  EXPECT_NO_THROW(drawn({c, c, c}, 2));
  EXPECT_THROW(drawCharts({}, 1, folder_ / "none.png"), std::invalid_argument);
  c.series = {{"unequal", {1, 2}, {1}, false, false}};
  EXPECT_THROW(drawCharts({c}, 1, folder_ / "none.png"), std::invalid_argument);
  EXPECT_FALSE(fs::exists(folder_ / "none.png"));
}

TEST_F(Charts, AMissingModuleSaysWhatToInstall) {
  setModuleFolder(folder_);
  Chart c{"Speed", "x", "y", false, false, false, {{"s", {1, 2}, {1, 2}, false, false}}, {}, {}};
  try {
    drawCharts({c}, 1, folder_ / "chart.png");
    ADD_FAILURE() << "drawn without the module";
  } catch (const UserError& e) {
    EXPECT_NE(std::string(e.what()).find("libvtk9-dev"), std::string::npos) << e.what();
  }
  setModuleFolder({});
  EXPECT_FALSE(fs::exists(folder_ / "chart.png"));
}

}  // namespace
}  // namespace pitviper
