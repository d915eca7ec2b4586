// What `bench` makes of its rows: tables, findings, CSV and charts, from rows with known figures.
#include <gtest/gtest.h>

#include <algorithm>

#include "scenarios/commands/bench_report.hpp"

namespace pitviper {
namespace {

/// A pass that takes 10 ms, and `share` of it for every layer more.
BenchRow row(const char* factor, int layers, const char* mode, double share) {
  BenchRow r;
  r.factor = factor;
  r.variant.value = std::to_string(layers);
  r.variant.x = layers;
  r.variant.mode = mode;
  r.variant.setting.layers = layers;
  r.variant.added = layers;
  r.frames = 60;
  r.timeByBase = 1.0 + share * layers;
  r.seconds = 0.010 * r.timeByBase;
  r.yardstickSeconds = 0.008;
  r.rateByYardstick = r.yardstickSeconds / r.seconds;
  if (layers > 0) r.costPerLayer = share;
  return r;
}

struct Layers {
  std::vector<BenchFactor> factors{{"layers", "transparent layers", {}}};
  std::vector<BenchRow> rows;
  Layers() {
    for (int n = 0; n <= 8; ++n) {
      rows.push_back(row("layers", n, "attenuation", 0.25));
      rows.push_back(row("layers", n, "emission and air", 0.4));
      rows.push_back(row("layers", n, "and reflection", 1.0));
    }
  }
};

TEST(BenchReport, StatesTheCostOfALayer) {
  const Layers l;
  const std::string text = benchTables(l.factors, l.rows);
  EXPECT_NE(text.find("a transparent layer (attenuation) costs 0.25 of the solid pass"), std::string::npos) << text;
  EXPECT_NE(text.find("(emission and air) costs 0.40"), std::string::npos);
  EXPECT_NE(text.find("(and reflection) costs 1.00"), std::string::npos);
  EXPECT_NE(text.find("| 8                  | attenuation      |     30.00 |      2.18 |      33.3 |         0.27 |"), std::string::npos) << text;
}

TEST(BenchReport, EveryCsvLineHasEveryColumn) {
  const Layers l;
  const std::string csv = benchCsv(l.rows);
  const auto columns = std::count(csv.begin(), csv.begin() + static_cast<std::ptrdiff_t>(csv.find('\n')), ',');
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 28);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), ','), 28 * columns);
  EXPECT_NE(csv.find("\nlayers,8,attenuation,256,16,16,1,1,8,60,30,8,2.18453,33.3333,0.266667,3,0.25\n"), std::string::npos) << csv;
}

TEST(BenchReport, ChartsHoldTheRows) {
  const Layers l;
  const auto charts = benchCharts(l.factors, l.rows);
  ASSERT_EQ(charts.size(), 1u);
  ASSERT_EQ(charts[0].series.size(), 5u);  // three kinds and the two limits
  EXPECT_DOUBLE_EQ(charts[0].series[0].y.back(), 3.0);
  EXPECT_DOUBLE_EQ(charts[0].series[1].y.back(), 4.2);
}

// Expected of every factor: each row is compared with one of its own factor and mode.
TEST(BenchReport, EveryVariantHasABaseOfItsMode) {
  for (const BenchFactor& f : benchFactors()) {
    EXPECT_FALSE(f.variants.empty()) << f.name;
    for (const BenchVariant& v : f.variants) {
      ASSERT_GE(v.base, 0) << f.name << " " << v.value;
      ASSERT_LT(static_cast<size_t>(v.base), f.variants.size());
      EXPECT_EQ(f.variants[static_cast<size_t>(v.base)].mode, v.mode) << f.name << " " << v.value;
    }
  }
}

// Expected: a wall fills the film, the visible plate is the last one, each has about 8000 triangles.
TEST(BenchReport, HiddenPlatesAreDrawnFirst) {
  BenchSetting s;
  s.overdraw = 7;
  s.triangles = 8000;
  const Simulation sim = benchSimulation(s);
  ASSERT_EQ(sim.entities.size(), 7u);
  EXPECT_EQ(sim.entities.back().name, "wall");
  for (size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(sim.entities[i].mesh->triangles.size(), 2u * 63u * 63u);
    EXPECT_NEAR(sim.entities[i].motion.at(0.0).position.x, static_cast<double>(i) - 6.0, 1e-12);
  }
}

}  // namespace
}  // namespace pitviper
