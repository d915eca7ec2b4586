// Pictures of trajectories: paths, shadows and marks where their numbers put them; nothing sensible is no crash.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "scenarios/commands/charts.hpp"
#include "scenarios/commands/trajectory_picture.hpp"
#include "sim/parameters/error.hpp"
#include "tests/support/read_png.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;
using glm::dvec3;

constexpr Rgb8 kFirst{0, 114, 178}, kSecond{213, 94, 0}, kRed{190, 20, 30};

/// Pixels that have a colour, and their mean column and row.
struct Spot {
  int count = 0;
  double column = 0.0, row = 0.0;
};

Spot spotOf(const Rgb8Image& p, Rgb8 colour, int right) {
  Spot s;
  for (int y = 64; y < p.height; ++y)
    for (int x = 0; x < right; ++x) {
      const Rgb8 c = p.at(x, y);
      if (std::abs(c.r - colour.r) + std::abs(c.g - colour.g) + std::abs(c.b - colour.b) > 50) continue;
      ++s.count, s.column += x, s.row += y;
    }
  if (s.count > 0) s.column /= s.count, s.row /= s.count;
  return s;
}

/// The legend lies right of this.
constexpr int kPlot_px = 925;

FlownPath line(const std::string& name, const dvec3& from, const dvec3& to, bool isCamera = false) {
  FlownPath p{name, {}, {}, isCamera};
  for (int i = 0; i <= 20; ++i) p.time_s.push_back(0.5 * i), p.position_m.push_back(glm::mix(from, to, i / 20.0));
  return p;
}

class Trajectories : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(fs::path(PITVIPER_BUILD_DIR) / "libpitviper_charts.so")) GTEST_SKIP() << "built without VTK";
  }
  Rgb8Image drawn(const FlownScene& scene) const {
    drawTrajectories(scene, folder_.path() / "t.png");
    return test::readPng(folder_.path() / "t.png");
  }
  test::TemporaryFolder folder_;
};

// Rationale: heights are up, whichever way it is looked from: of two paths over the same ground the higher is drawn higher, and an approach between them.
TEST_F(Trajectories, AreWhereTheirNumbersPutThem) {
  FlownScene scene{"two", {line("low", {0, 0, 100}, {1000, 0, 100}), line("high", {0, 0, 600}, {1000, 0, 600})}, {}, {}};
  const Rgb8Image two = drawn(scene);
  const Spot low = spotOf(two, kFirst, kPlot_px), high = spotOf(two, kSecond, kPlot_px);
  ASSERT_GT(low.count, 500);
  ASSERT_GT(high.count, 500);
  EXPECT_GT(low.row, high.row + 100.0);
  // Straight above one another: but for what labels and shadows hide of them.
  EXPECT_NEAR(low.column, high.column, 12.0);
  EXPECT_EQ(spotOf(two, kRed, kPlot_px).count, 0);
  scene.meetings.push_back({"low", "high", 5.0, 500.0, {500, 0, 100}, {500, 0, 600}});
  const Spot meeting = spotOf(drawn(scene), kRed, kPlot_px);
  ASSERT_GT(meeting.count, 100);
  EXPECT_LT(std::abs(meeting.row - 0.5 * (low.row + high.row)), 0.5 * (low.row - high.row));
}

// Rationale: a flight 50 km long that climbs by 30 m would be a line on the floor; its heights are exaggerated, so that the climb is seen.
TEST_F(Trajectories, OfFlatScenesHaveTheirHeightsExaggerated) {
  const Rgb8Image flat = drawn({"flat", {line("first", {0, 0, 10}, {50e3, 20e3, 10}), line("second", {0, 0, 60}, {50e3, 20e3, 60})}, {}, {}});
  EXPECT_GT(spotOf(flat, kFirst, kPlot_px).row, spotOf(flat, kSecond, kPlot_px).row + 20.0);
}

// Rationale: a camera very far away must not shrink what is flown; bodies that vanish leave gaps; one place, one time, numbers that are none and long names are
// drawn.
TEST_F(Trajectories, OfAnythingAreNoCrash) {
  FlownScene scene{"odd", {line("near", {0, 0, 100}, {1000, 300, 300})}, {}, {}};
  const int alone = spotOf(drawn(scene), kFirst, kPlot_px).count;
  scene.paths.push_back(line("moon", {4e8, 0, 0}, {4e8, 1, 0}, true));
  scene.sights.push_back({"moon", 5.0, {4e8, 0, 0}, {-1, 0, 0}, 4e8});
  EXPECT_GT(spotOf(drawn(scene), kFirst, kPlot_px).count, alone * 3 / 4);
  FlownPath gap = line("gap", {0, 0, 0}, {10, 10, 1000});
  for (std::size_t i = 5; i < 9; ++i) gap.position_m[i] = dvec3(NAN);
  EXPECT_NO_THROW(drawn({"", {gap}, {}, {}}));
  EXPECT_NO_THROW(drawn({std::string(500, 'x'), {{std::string(200, 'y'), {1.0}, {{5, 5, 5}}, false}}, {}, {}}));
  EXPECT_NO_THROW(drawn({"far",
                         {line("a", {1e9, 1e9, -1e3}, {1e9, 1e9 + 1.0, -1e3})},
                         {{"a", "a", NAN, NAN, {1e9, 1e9, -1e3}, {1e9, 1e9, -1e3}}},
                         {{"c", 0, {0, 0, 0}, {0, 0, 1}, 0}}}));
  EXPECT_THROW(drawn({"none", {{"nowhere", {1.0}, {dvec3(NAN)}, false}}, {}, {}}), std::invalid_argument);
  EXPECT_THROW(drawn({"unequal", {{"a", {1.0, 2.0}, {dvec3(0)}, false}}, {}, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace pitviper
