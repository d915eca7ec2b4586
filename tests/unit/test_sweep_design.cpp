// Sweeps: distributions and designs against closed forms, samples against the file that they are drawn from, and what is said of mistakes in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>

#include "scenarios/reader/yaml_tree.hpp"
#include "scenarios/sweep/distribution.hpp"
#include "scenarios/sweep/sample_design.hpp"
#include "scenarios/sweep/sobol_indices.hpp"
#include "scenarios/sweep/sobol_sequence.hpp"
#include "scenarios/sweep/sweep_file.hpp"
#include "scenarios/sweep/yaml_line.hpp"
#include "sim/parameters/units.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

struct SweepFile : testing::Test {
  TemporaryFolder folder;

  SweepFile() { folder.put("scene.yaml", "name: scene\n"); }

  Sweep sweep(const std::string& text) const { return readSweep(folder.put("sweep.yaml", text)); }
  /// With what every sweep has before it.
  Sweep of(const std::string& rest) const { return sweep("sweep: s\nscenario: scene.yaml\n" + rest); }
  /// The message, the folder's name left out of it.
  std::string refusal(const std::string& text) const {
    try {
      sweep(text);
    } catch (const UserError& e) {
      std::string message = e.what();
      const std::string own = folder.path().string() + "/";
      for (std::size_t at = message.find(own); at != std::string::npos; at = message.find(own)) message.erase(at, own.size());
      return message;
    }
    return "nothing refused";
  }
};

std::vector<double> drawsOf(const Sweep& sweep, std::size_t factor) {
  std::vector<double> all;
  for (const Sample& s : sweep.samples) all.push_back(s.values[factor]);
  return all;
}

double standardNormal(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

/// Kolmogorov's and Smirnov's statistic times the root of the number of draws; `shareBelow` is the distribution function.
template <class Function>
double distanceFrom(std::vector<double> draws, Function shareBelow) {
  std::sort(draws.begin(), draws.end());
  const auto n = static_cast<double>(draws.size());
  double most = 0.0;
  for (std::size_t k = 0; k < draws.size(); ++k) {
    const double p = shareBelow(draws[k]);
    most = std::max({most, p - static_cast<double>(k) / n, static_cast<double>(k + 1) / n - p});
  }
  return most * std::sqrt(n);
}

/// Of that, for a chance of 1e-6: sqrt(-ln(1e-6 / 2) / 2) (Smirnov 1948).
const double kCritical = std::sqrt(-0.5 * std::log(0.5e-6));

// Closed forms; those of the cut normal distribution with mpmath, 40 digits. Tolerance: some roundings.
TEST(Distribution, QuantilesAreKnown) {
  EXPECT_DOUBLE_EQ(Distribution::uniform(2.0, 8.0).quantile(0.25), 3.5);
  EXPECT_DOUBLE_EQ(Distribution::uniform(-1.7e308, 1.7e308).quantile(0.5), 0.0);
  EXPECT_NEAR(Distribution::logUniform(5.0, 50.0).quantile(0.5), std::sqrt(250.0), 1e-14);
  EXPECT_NEAR(Distribution::logUniform(1e-200, 1e200).quantile(0.75) / 1e100, 1.0, 1e-13);
  EXPECT_NEAR(Distribution::normal(300.0, 10.0).quantile(0.975), 319.59963984540054, 1e-12);
  EXPECT_NEAR(Distribution::normal(0.0, 1.0, -1.0, 2.0).quantile(0.5), 0.17116391801782477, 1e-15);
  EXPECT_NEAR(Distribution::normal(0.0, 1.0, 4.5, 6.0).quantile(0.3), 4.5752140084422345, 2e-15);
  EXPECT_NEAR(Distribution::normal(0.0, 1.0, -6.0, -4.5).quantile(0.7), -4.5752140084422345, 2e-15);
  EXPECT_NEAR(normalShare(0.0, 1.0, 4.5, 6.0) / 3.396686537085022703e-6, 1.0, 1e-13);
  EXPECT_NEAR(normalShare(10.0, 2.0, 8.0, 12.0), 0.682689492137086, 1e-15);
}

TEST(Distribution, StaysWithinItsBoundsAndRises) {
  const Distribution all[] = {Distribution::uniform(0.1, 0.3), Distribution::logUniform(0.1, 0.3), Distribution::normal(0.2, 0.05, 0.1, 0.3),
                              Distribution::normal(0.0, 0.06, 0.1, 0.3), Distribution::normal(0.4, 0.06, 0.1, 0.3)};
  for (const Distribution& d : all) {
    double before = 0.1;
    for (double u : {0x1p-53, 1e-9, 0.1, 0.5, 0.9, 1.0 - 1e-9, 1.0 - 0x1p-53}) {
      EXPECT_GE(d.quantile(u), before);
      before = d.quantile(u);
    }
    EXPECT_LE(before, 0.3);
  }
}

TEST(Distribution, OneOfAListByWeights) {
  const Distribution equal = Distribution::oneOf({7.0, 8.0, 9.0});
  EXPECT_EQ(equal.quantile(0.333), 7.0);
  EXPECT_EQ(equal.quantile(0.334), 8.0);
  EXPECT_EQ(equal.quantile(1.0 - 0x1p-53), 9.0);
  const Distribution weighed = Distribution::oneOf({0.0, 1.0, 2.0, 3.0}, {0.0, 2.0, 1.0, 0.0});
  EXPECT_EQ(weighed.quantile(0x1p-53), 1.0);
  EXPECT_EQ(weighed.quantile(0.66), 1.0);
  EXPECT_EQ(weighed.quantile(0.67), 2.0);
  EXPECT_EQ(weighed.quantile(1.0 - 0x1p-53), 2.0);
}

TEST_F(SweepFile, DrawsFollowTheirDistributions) {
  const Sweep s = of(R"yaml(samples: 20000
seed: 11
vary:
  - {name: a, key: a, uniform: [2 km, 8 km]}
  - {name: b, key: b, log_uniform: [5 km, 50 km]}
  - {name: c, key: c, normal: {mean: 300 K, sigma: 10 K}, within: [290 K, 340 K]}
  - {name: d, key: d, choice: [grey, black, white], weights: [2, 1, 1]}
)yaml");
  ASSERT_EQ(s.samples.size(), 20000u);
  const std::string source = "chance of 1e-6";
  const auto cut = [](double x) { return (standardNormal((x - 300.0) / 10.0) - standardNormal(-1.0)) / (standardNormal(4.0) - standardNormal(-1.0)); };
  bound("uniform draws: distance from their distribution", distanceFrom(drawsOf(s, 0), [](double x) { return (x - 2.0) / 6.0; }), kCritical, source);
  bound("log-uniform draws: the same", distanceFrom(drawsOf(s, 1), [](double x) { return std::log10(x / 5.0); }), kCritical, source);
  bound("cut normal draws: the same", distanceFrom(drawsOf(s, 2), cut), kCritical, source);
  const std::vector<double> words = drawsOf(s, 3), a = drawsOf(s, 0), b = drawsOf(s, 1);
  const double share = static_cast<double>(std::count(words.begin(), words.end(), 0.0)) / 20000.0;
  bound("share of the first of three choices off 1/2", std::abs(share - 0.5), 4.9 * 0.5 / std::sqrt(20000.0), "4.9 standard deviations: chance of 1e-6");
  double product = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) product += std::sqrt(12.0) * ((a[k] - 2.0) / 6.0 - 0.5) * std::sqrt(12.0) * (std::log10(b[k] / 5.0) - 0.5);
  bound("correlation of two factors", std::abs(product / 20000.0), 4.9 / std::sqrt(20000.0), "4.9 standard deviations");
}

TEST(SampleDesign, LatinHypercubeHasOneInEachStratum) {
  for (int n : {1, 2, 7, 1000, 4096}) {
    const SampleDesign design(Design::LatinHypercube, 5, n, 3);
    std::vector<std::set<int>> strata(3);
    std::vector<int> order[3];
    for (int k = 0; k < n; ++k)
      for (std::size_t f = 0; f < 3; ++f) {
        order[f].push_back(static_cast<int>(design.point(k)[f] * n));
        strata[f].insert(order[f].back());
      }
    for (std::size_t f = 0; f < 3; ++f) {
      EXPECT_EQ(static_cast<int>(strata[f].size()), n);
      EXPECT_EQ(*strata[f].begin(), 0);
      EXPECT_EQ(*strata[f].rbegin(), n - 1);
    }
    if (n < 1000) continue;
    EXPECT_NE(order[0], order[1]);
    EXPECT_FALSE(std::is_sorted(order[0].begin(), order[0].end()));
  }
  // Within its stratum each is anywhere.
  const SampleDesign design(Design::LatinHypercube, 6, 5000, 1);
  std::vector<double> within;
  for (int k = 0; k < 5000; ++k) within.push_back(design.point(k)[0] * 5000.0 - std::floor(design.point(k)[0] * 5000.0));
  bound("places within strata: distance from uniform", distanceFrom(within, [](double x) { return x; }), kCritical, "chance of 1e-6");
}

// Source: S. Joe and F. Y. Kuo's own example of three dimensions.
TEST(SobolSequence, FirstPointsAreAsPublished) {
  const double published[][3] = {{0, 0, 0},
                                 {0.5, 0.5, 0.5},
                                 {0.75, 0.25, 0.25},
                                 {0.25, 0.75, 0.75},
                                 {0.375, 0.375, 0.625},
                                 {0.875, 0.875, 0.125},
                                 {0.625, 0.125, 0.875},
                                 {0.125, 0.625, 0.375},
                                 {0.1875, 0.3125, 0.9375},
                                 {0.6875, 0.8125, 0.4375}};
  const SobolSequence sequence(3);
  for (std::uint32_t k = 0; k < 10; ++k)
    for (std::size_t d = 0; d < 3; ++d) EXPECT_EQ(static_cast<double>(sequence.bits(k, d)) * 0x1p-64, published[k][d]) << k << " " << d;
}

TEST(SampleDesign, SobolIsBalancedAtPowersOfTwo) {
  const SampleDesign design(Design::Sobol, 9, 1024, 20);
  for (int n : {2, 64, 1024}) {
    std::vector<std::set<int>> strata(20);
    std::set<std::pair<int, int>> cells;
    for (int k = 0; k < n; ++k) {
      const std::vector<double> u = design.point(k);
      for (std::size_t f = 0; f < 20; ++f) strata[f].insert(static_cast<int>(u[f] * n));
      cells.emplace(static_cast<int>(u[0] * 32), static_cast<int>(u[1] * 32));
    }
    for (const auto& s : strata) EXPECT_EQ(static_cast<int>(s.size()), n);
    if (n == 1024) {
      EXPECT_EQ(cells.size(), 1024u);  // a (0, 10, 2)-net: one in each of 32 x 32 cells
    }
  }
  EXPECT_NE(design.point(0), SampleDesign(Design::Sobol, 10, 1024, 20).point(0));  // the shift
}

TEST(SampleDesign, PointsDependOnTheirNumberAlone) {
  for (Design kind : {Design::Random, Design::LatinHypercube, Design::Sobol, Design::SobolIndices}) {
    const SampleDesign design(kind, 3, 64, 4), again(kind, 3, 64, 4), other(kind, 4, 64, 4);
    std::vector<std::vector<double>> all;
    for (int k = 0; k < 64; ++k) all.push_back(design.point(k));
    for (int k = 63; k >= 0; k -= 7) {
      EXPECT_EQ(again.point(k), all[static_cast<std::size_t>(k)]);
      EXPECT_NE(other.point(k), all[static_cast<std::size_t>(k)]);
    }
    for (const auto& u : all)
      for (double v : u) EXPECT_TRUE(v > 0.0 && v < 1.0);
  }
  std::set<std::uint64_t> seeds;
  for (int k = 0; k < 1000; ++k) {
    seeds.insert(sampleSeed(7, k));
    seeds.insert(sampleSeed(8, k));
    EXPECT_LT(sampleSeed(7, k), std::uint64_t{1} << 53);
  }
  EXPECT_EQ(seeds.size(), 2000u);
}

TEST(SampleDesign, RowsOfSaltelli) {
  const std::size_t d = 3;
  const SampleDesign design(Design::SobolIndices, 2, 8, d);
  EXPECT_EQ(design.size(), 8 * 5);
  for (int n = 0; n < 8; ++n) {
    const std::vector<double> a = design.point(n * 5), b = design.point(n * 5 + 1);
    for (std::size_t i = 1; i <= d; ++i) {
      const int number = n * 5 + 1 + static_cast<int>(i);
      const SaltelliRow row = saltelliRow(number, d);
      EXPECT_EQ(row.base, n);
      EXPECT_EQ(row.matrix, static_cast<int>(i));
      std::vector<double> mixed = a;
      EXPECT_NE(a[i - 1], b[i - 1]);
      mixed[i - 1] = b[i - 1];
      EXPECT_EQ(design.point(number), mixed);
    }
  }
}

// Of x0 + 2 x1 the indices are 1/5 and 4/5, of first order and total. Estimators: Saltelli 2010, table 2, (b) and (f).
TEST(SampleDesign, SaltellisRowsGiveIndices) {
  constexpr int kBase = 1024;
  const SampleDesign design(Design::SobolIndices, 2, kBase, 2);
  const auto f = [&](int number) {
    const std::vector<double> u = design.point(number);
    return u[0] + 2.0 * u[1];
  };
  const double variance = 5.0 / 12.0;
  double first[2] = {}, total[2] = {};
  for (int n = 0; n < kBase; ++n)
    for (int i = 0; i < 2; ++i) {
      const double a = f(n * 4), mixed = f(n * 4 + 2 + i), b = f(n * 4 + 1);
      first[i] += b * (mixed - a) / kBase / variance;
      total[i] += (a - mixed) * (a - mixed) / 2.0 / kBase / variance;
    }
  // What the report of a sweep makes of its samples in their order.
  std::vector<double> results;
  for (int number = 0; number < design.size(); ++number) results.push_back(f(number));
  const SobolIndices reported = sobolIndices(results, 2);
  // Of as many random points the standard error of a first-order index is 0.05; a Sobol sequence leaves less than an eighth of it.
  for (int i = 0; i < 2; ++i) {
    const double exact = i == 0 ? 0.2 : 0.8;
    bound("first-order index by Saltelli's rows off its own", std::abs(first[i] - exact), 0.006, "an eighth of what random points leave");
    bound("first-order index that a sweep reports off its own", std::abs(reported.factors[static_cast<std::size_t>(i)].first - exact), 0.006,
          "an eighth of what random points leave");
    bound("total index by them off its own", std::abs(total[i] - exact), 0.006, "an eighth of what random points leave");
  }
}

TEST_F(SweepFile, GridHasAllCombinationsTheLastFactorFirst) {
  const Sweep s = of(R"yaml(design: grid
vary:
  - {name: a, key: a, values: [1 km, 2 km]}
  - {name: b, key: b, choice: [x, y, z]}
  - {name: c, key: c, grid: {from: 1, to: 0, steps: 5}}
)yaml");
  ASSERT_EQ(s.samples.size(), 30u);
  int k = 0;
  for (double a : {1.0, 2.0})
    for (double b : {0.0, 1.0, 2.0})
      for (double c : {1.0, 0.75, 0.5, 0.25, 0.0}) {
        const Sample& sample = s.samples[static_cast<std::size_t>(k)];
        EXPECT_EQ(sample.number, k++);
        EXPECT_EQ(sample.values, (std::vector<double>{a, b, c}));
      }
  EXPECT_EQ(s.samples[29].sets, (std::vector<std::string>{"a=2 km", "b=z", "c=0"}));
}

TEST_F(SweepFile, SetsHoldFactorsAndExpressions) {
  folder.put("points.csv", "note [1],turn [deg],range [km],paint [-]\n0,60,3.25,1\n0,0,0.1,2\n");
  const Sweep s = of(R"yaml(design: table
table: points.csv
frame: 12
keep_frames: yes
sinks: [files, {model: shared_memory}]
vary:
  - {name: range}
  - {name: turn}
  - {name: paint, key: entities.jet.material, choice: [grey, "black: flat", '7 K']}
set:
  entities.jet.position: ["= $range * cos($turn)", "= ${range} * 0.5", 500 m]
  cameras.0.film: {width: "= 4 * 8", note: "$$ $range off", deep: [$paint, [$range]]}
  lamp.temperature: "= 280 K + 5 K"
  atmosphere: none
)yaml");
  EXPECT_EQ(s.name, "s");
  EXPECT_EQ(s.scenario, folder.path() / "scene.yaml");
  EXPECT_EQ(s.frame, 12);
  EXPECT_TRUE(s.keepsFrames);
  EXPECT_EQ(s.seed, 1);
  ASSERT_EQ(s.sinks.items.size(), 2u);
  EXPECT_EQ(s.sinks.items[1].find("model")->text, "shared_memory");
  EXPECT_EQ(s.factors[0].unit, "km");
  EXPECT_EQ(s.factors[2].choices, (std::vector<std::string>{"grey", "black: flat", "7 K"}));
  EXPECT_EQ(s.sets, (std::vector<std::string>{"lamp.temperature=285 K", "atmosphere=none"}));
  ASSERT_EQ(s.samples.size(), 2u);
  EXPECT_EQ(s.samples[0].values, (std::vector<double>{3.25, 60.0, 1.0}));
  ASSERT_EQ(s.samples[0].sets.size(), 3u);
  EXPECT_EQ(s.samples[0].sets[0], "entities.jet.material=\"black: flat\"");
  EXPECT_EQ(s.samples[1].sets[1], "entities.jet.position=[0.1 km, 0.05 km, 500 m]");
  EXPECT_EQ(s.samples[1].sets[2], "cameras.0.film={width: 32, note: \"$ 0.1 km off\", deep: [7 K, [0.1 km]]}");

  Value tree = parseYaml("entities: [{name: jet, position: [1, 2, 3]}]\n", "x");
  for (const std::string& set : {s.samples[0].sets[0], s.samples[0].sets[1]}) applyOverride(tree, set);
  const Value& jet = tree.find("entities")->items[0];
  EXPECT_EQ(jet.find("material")->text, "black: flat");
  EXPECT_NEAR(readNumber(jet.find("position")->items[0], "m", "x"), 1625.0, 1e-9);  // cos(60 deg), some roundings
  EXPECT_EQ(readNumber(jet.find("position")->items[1], "m", "x"), 1625.0);
}

TEST_F(SweepFile, NumbersReadBackAsTheyWere) {
  const Sweep s = of(R"yaml(samples: 500
vary:
  - {name: a, key: a, log_uniform: [1e-300 m, 1e300 m]}
  - {name: b, key: b, uniform: [-3, 3]}
)yaml");
  for (const Sample& sample : s.samples)
    for (std::size_t f = 0; f < 2; ++f) {
      const auto q = splitQuantity(sample.sets[f].substr(2));
      ASSERT_TRUE(q) << sample.sets[f];
      EXPECT_EQ(q->value, sample.values[f]);
      EXPECT_EQ(q->unit, f == 0 ? "m" : "");
    }
}

TEST_F(SweepFile, LinesOfYamlAreReadAsTheyWere) {
  const std::string text =
      R"yaml({a: [1 km, -5 m, +3, .5, "", ' x', "null", ~, "a \"b\" \\ c", "two\nlines", "é # no: x", "-", "- 3", "{}", "= 3"], "b: c": {}, d: []})yaml";
  const Value value = parseYaml(text, "x"), again = parseYaml(yamlLine(value), "x");
  EXPECT_EQ(yamlLine(value).find('\n'), std::string::npos);
  EXPECT_EQ(wordsOf(again), wordsOf(value));
  ASSERT_EQ(again.entries[0].second.items.size(), 15u);
  for (std::size_t k = 0; k < 15; ++k) {
    EXPECT_EQ(again.entries[0].second.items[k].kind, value.entries[0].second.items[k].kind) << k;
    EXPECT_EQ(again.entries[0].second.items[k].text, value.entries[0].second.items[k].text) << k;
  }
}

// Every way of varying, in one file.
TEST_F(SweepFile, WholeFileIsDrawn) {
  const Sweep s = of(R"yaml(seed: 7
samples: 300
vary:
  - {name: range, uniform: [2 km, 8 km]}
  - {name: aspect, uniform: [0 deg, 360 deg]}
  - {name: temperature, key: entities.jet.temperature, normal: {mean: 300 K, sigma: 10 K}, within: [260 K, 340 K]}
  - {name: visibility, key: atmosphere.visibility, log_uniform: [5 km, 50 km]}
  - {name: paint, key: entities.jet.material, choice: [grey_aircraft_paint, flat_black_paint], weights: [2, 1]}
  - {name: step, key: step, values: [1 km, 2 km, 3 km]}
  - {name: level, key: level, grid: {from: 0.1, to: 0.4, steps: 4}}
set:
  entities.jet.position: ["= $range * cos($aspect)", "= $range * sin($aspect)", 500 m]
constraints: ["$range < 0.5 * $visibility"]
)yaml");
  ASSERT_EQ(s.samples.size(), 300u);
  std::set<double> steps, levels;
  for (const Sample& sample : s.samples) {
    EXPECT_LT(sample.values[0], 0.5 * sample.values[3]);
    steps.insert(sample.values[5]);
    levels.insert(sample.values[6]);
    ASSERT_EQ(sample.sets.size(), 6u);  // of each factor with a key, then of `set`
    const std::string path = "entities.jet.position=";
    ASSERT_TRUE(sample.sets[5].starts_with(path)) << sample.sets[5];
    const Value position = parseYaml(sample.sets[5].substr(path.size()) + "\n", "x");
    const glm::dvec3 p = readVector(position, "km", "position");
    EXPECT_NEAR(std::hypot(p.x, p.y), sample.values[0], 1e-12);  // some roundings of a cosine and a sine
    EXPECT_EQ(p.z, 0.5);
    EXPECT_TRUE(sample.sets[2] == "entities.jet.material=grey_aircraft_paint" || sample.sets[2] == "entities.jet.material=flat_black_paint");
  }
  EXPECT_EQ(steps, (std::set<double>{1.0, 2.0, 3.0}));
  ASSERT_EQ(levels.size(), 4u);
  EXPECT_EQ(*levels.begin(), 0.1);
  EXPECT_EQ(*levels.rbegin(), 0.4);
}

const char* const kTriangle = R"yaml(vary:
  - {name: a, key: a, uniform: [0 km, 1 km]}
  - {name: b, key: b, uniform: [0 m, 1000 m]}
constraints: ["$a <= 2 * $b", "$b + 100 m > $a * 0.5"]
)yaml";

TEST_F(SweepFile, ConstraintsHold) {
  const Sweep drawn = of(std::string("samples: 400\n") + kTriangle);
  EXPECT_EQ(drawn.samples.size(), 400u);
  const SampleDesign free(Design::Random, 1, 400, 2);
  int others = 0;
  for (const Sample& s : drawn.samples) {
    const double a_m = 1000.0 * s.values[0], b_m = s.values[1];
    EXPECT_LE(a_m, 2.0 * b_m);
    EXPECT_GT(b_m + 100.0, 0.5 * a_m);
    others += s.values[0] != free.point(s.number)[0];
  }
  bound("share of draws that were drawn again off 1/4", std::abs(others / 400.0 - 0.25), 4.9 * std::sqrt(0.25 * 0.75 / 400.0), "4.9 standard deviations");

  const Sweep sobol = of(std::string("design: sobol\nsamples: 1024\n") + kTriangle);
  bound("share of Sobol points that are left off 3/4", std::abs(static_cast<double>(sobol.samples.size()) / 1024.0 - 0.75), 64.0 / 1024.0,
        "cells of 32 x 32 that the line a = 2 b cuts");
  const SampleDesign points(Design::Sobol, 1, 1024, 2);
  for (const Sample& s : sobol.samples) {
    EXPECT_LE(s.values[0] * 1000.0, 2.0 * s.values[1]);
    EXPECT_DOUBLE_EQ(s.values[0], points.point(s.number)[0]);  // numbers are those of the design
    EXPECT_EQ(s.seed, sampleSeed(1, s.number));
  }
}

TEST_F(SweepFile, MoreSamplesLeaveTheFirstAsTheyWere) {
  for (const char* design : {"random", "sobol"}) {
    const std::string head = std::string("design: ") + design + "\nsamples: ";
    const Sweep few = of(head + "20\n" + kTriangle), many = of(head + "200\n" + kTriangle);
    ASSERT_GT(few.samples.size(), 5u);
    ASSERT_GT(many.samples.size(), few.samples.size());
    for (std::size_t k = 0; k < few.samples.size(); ++k) {
      EXPECT_EQ(few.samples[k].number, many.samples[k].number);
      EXPECT_EQ(few.samples[k].seed, many.samples[k].seed);
      EXPECT_EQ(few.samples[k].values, many.samples[k].values);
      EXPECT_EQ(few.samples[k].sets, many.samples[k].sets);
    }
    EXPECT_NE(of(head + "20\nseed: 2\n" + kTriangle).samples[0].values, few.samples[0].values);
  }
}

TEST_F(SweepFile, MeasuresAreRead) {
  folder.put("measures.py", "def contrast(frame): return 1, 2\n");
  const std::string text = R"yaml(samples: 1
vary: [{name: a, key: a, uniform: [0, 1]}]
measures:
  - {name: snr, truth: jet, value: mw.snr}
  - {name: mean, statistic: p99.5, layer: mw.radiance, camera: tracker, region: [0, 4, 32, 16]}
  - {python: measures.py, function: contrast, names: [contrast, peak], units: ["1", "W/(m2 sr)"]
}
)yaml";
  const Sweep s = of(text);
  ASSERT_EQ(s.measures.size(), 4u);
  EXPECT_EQ(s.measures[0].kind, Measure::Kind::Truth);
  EXPECT_EQ(s.measures[0].target, "jet");
  EXPECT_EQ(s.measures[0].value, "mw.snr");
  EXPECT_EQ(s.measures[0].where.line, 6);
  EXPECT_EQ(s.measures[1].kind, Measure::Kind::Statistic);
  EXPECT_EQ(s.measures[1].statistic, "p99.5");
  EXPECT_EQ(s.measures[1].layer, "mw.radiance");
  EXPECT_EQ(s.measures[1].camera, "tracker");
  EXPECT_EQ(s.measures[1].region, (std::vector<int>{0, 4, 32, 16}));
  EXPECT_EQ(s.measures[2].kind, Measure::Kind::Python);
  EXPECT_EQ(s.measures[2].function, "contrast");
  EXPECT_EQ(s.measures[2].names, (std::vector<std::string>{"contrast", "peak"}));
  EXPECT_EQ(s.measures[2].units, (std::vector<std::string>{"", "W/(m2 sr)"}));
  EXPECT_EQ(s.measures[2].file, folder.path() / "measures.py");
  EXPECT_EQ(s.sha256.size(), 64u);
  EXPECT_EQ(of(text).sha256, s.sha256);
  folder.put("measures.py", "def contrast(frame): return 1, 3\n");
  EXPECT_NE(of(text).sha256, s.sha256);
}

/// A sweep that is right but for one line, and what is said of that.
struct Mistake {
  const char* text;
  const char* place;  ///< line:column
  const char* part;
};

TEST_F(SweepFile, MistakesAreToldWithTheirPlaces) {
  folder.put("few.csv", "a [km]\n1\n");
  folder.put("nan.csv", "a [km]\n1\nnan\n");
  folder.put("twice.csv", "a [km],a [m]\n1,2\n");
  folder.put("none.csv", "a [km]\n");
  folder.put("unit.csv", "a [kmm]\n1\n");
  folder.put("place.csv", "a [1]\n0\n2\n");
  folder.put("m.py", "\n");
  const std::string head = "sweep: s\nscenario: scene.yaml\n";  // lines 1 and 2
  const Mistake mistakes[] = {
      // Keys and designs.
      {"samples: 2\nvery: []\n", "4:1", "unknown key 'very' in sweep; expected one of sweep, scenario"},
      {"vary: [{name: a, key: a, uniform: [0, 1]}]\n", "1:1", "missing key 'samples' in sweep; expected the number of samples; fix: add 'samples: 1000'"},
      {"samples: 0\nvary: [{name: a, key: a, uniform: [0, 1]}]\n", "3:10", "samples is out of range (0)"},
      {"samples: 10000001\nvary: [{name: a, key: a, uniform: [0, 1]}]\n", "3:10", "samples is out of range (10000001)"},
      {"samples: 2\ndesign: halton\nvary: []\n", "4:9", "design cannot be 'halton'; expected one of random, latin_hypercube"},
      {"samples: 2\nvary: []\n", "4:7", "vary has 0 entries; expected 1 to 256"},
      {"samples: 2\ndesign: grid\nvary: [{name: a, key: a, values: [1, 2]}]\n", "3:10", "samples of a grid, which has all combinations; expected no 'samples'"},
      {"design: grid\nvary: [{name: a, key: a, uniform: [1, 2]}]\n", "4:35", "'uniform' has no single values, as a grid needs"},
      {"design: grid\nvary: [{name: a, key: a, choice: [x, y], weights: [1, 2]}]\n", "4:51", "weights in a grid, where nothing is drawn"},
      {"design: grid\nvary:\n- {name: a, key: a, grid: {from: 0, to: 1, steps: 4000}}\n- {name: b, key: b, grid: {from: 0, to: 1, steps: 4000}}\n", "5:1",
       "a grid of more than 10 million combinations"},
      {"samples: 5000000\ndesign: sobol_indices\nvary: [{name: a, key: a, uniform: [0, 1]}]\n", "3:10", "5000000 samples of 1 factors are 15000000 pictures"},
      {"samples: 2\ndesign: sobol_indices\nvary: [{name: a, key: a, uniform: [0, 1]}]\nconstraints: [\"$a < 1\"]\n", "6:14",
       "constraints of the design sobol_indices"},
      {"samples: 2\nscenario: other.yaml\nvary: []\n", "4:1", "duplicate key 'scenario'"},
      // Distributions.
      {"samples: 2\nvary: [{name: a, key: a}]\n", "4:8", "nothing says how 'a' is drawn; expected one of uniform, log_uniform"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1], values: [1]}]\n", "4:51", "a factor has both 'uniform' and 'values'"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [3 km, 2 km]}]\n", "4:35",
       "uniform from 3 km to 2 km; expected [low, high] with low < high; fix: write [2 km, 3 km]"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [2 km, 2 km]}]\n", "4:35", "uniform from 2 km to 2 km"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [2 km]}]\n", "4:35", "uniform has 1 entries; expected 2 to 2"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [500 m, 2]}]\n", "4:43", "'a' has the units 'm' and none"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [1 kmm, 2 kmm]}]\n", "4:36", "there is no unit 'kmm'"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [1, nan]}]\n", "4:39", "a value of 'a' is 'nan'; expected a finite number"},
      {"samples: 2\nvary: [{name: a, key: a, log_uniform: [0 m, 2 m]}]\n", "4:40", "log_uniform from 0 m; expected a value above 0"},
      {"samples: 2\nvary: [{name: a, key: a, log_uniform: [1 degC, 2 degC]}]\n", "4:39", "log_uniform of values in degC"},
      {"samples: 2\nvary: [{name: a, key: a, normal: {mean: 3 K, sigma: 0 K}}]\n", "4:53", "sigma is 0 K; expected a standard deviation above 0"},
      {"samples: 2\nvary: [{name: a, key: a, normal: {mean: 3 K, deviation: 1 K}}]\n", "4:46", "unknown key 'deviation' in normal distribution of a factor"},
      {"samples: 2\nvary: [{name: a, key: a, normal: {mean: 3 K, sigma: 1 K}, within: [8 K, 9 K]}]\n", "4:67",
       "within holds 2.86e-07 of the normal distribution"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1], within: [0, 1]}]\n", "4:51", "'within' goes with 'normal' only"},
      {"samples: 2\nvary: [{name: a, key: a, choice: [x, y], weights: [1]}]\n", "4:51", "1 weights of 2 choices; expected a weight for each"},
      {"samples: 2\nvary: [{name: a, key: a, choice: [x, y], weights: [0, 0]}]\n", "4:51", "the weights' sum is 0"},
      {"samples: 2\nvary: [{name: a, key: a, choice: [x, y], weights: [2, -1]}]\n", "4:55", "the weight -1; expected 0 or more"},
      {"samples: 2\nvary: [{name: a, key: a, choice: [x, x]}]\n", "4:38", "the choice 'x' is there twice"},
      {"samples: 2\nvary: [{name: a, key: a, grid: {from: 1 m, to: 1 m, steps: 3}}]\n", "4:48", "the grid goes from 1 m to itself"},
      {"samples: 2\nvary: [{name: a, key: a, normal: {mean: 1e308, sigma: 1e308}}]\n", "4:55", "beyond what a number holds"},
      // Names and paths.
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}, {name: a, key: b, uniform: [0, 1]}]\n", "4:51", "two factors are called 'a' (sweep.yaml:4:15)"},
      {"samples: 2\nvary: [{name: 2a, key: a, uniform: [0, 1]}]\n", "4:15", "a column cannot be called '2a'"},
      {"samples: 2\nvary: [{name: seed, key: a, uniform: [0, 1]}]\n", "4:15", "every sweep has a column 'seed'"},
      {"samples: 2\nvary: [{name: a, uniform: [0, 1]}]\n", "4:15", "nothing uses the factor 'a'"},
      {"samples: 2\nvary: [{name: a, key: a.., uniform: [0, 1]}]\n", "4:23", "'a..' is no path"},
      {"samples: 2\nvary: [{name: a, key: a.b, uniform: [0, 1]}]\nset: {a.b: 3}\n", "5:7", "'a.b' is set twice (sweep.yaml:4:23)"},
      {"samples: 2\nvary: [{name: a, key: a.b.c, uniform: [0, 1]}]\nset: {a.b: 3}\n", "4:23", "'a.b.c' is within 'a.b', which is set too (sweep.yaml:5:7)"},
      // Expressions and constraints.
      {"samples: 2\nvary: [{name: range, key: a, uniform: [0, 1]}]\nset: {b: [[\"= 2 * $rang\"]]}\n", "5:12",
       "there is no factor 'rang'; expected one of range; fix: did you mean 'range'?"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nset: {b: cost $}\n", "5:10", "a dollar without a name"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nset: {b: \"= $a + 3 km\"}\n", "5:10", "cannot be added"},
      {"samples: 2\nvary: [{name: a, key: a, choice: [grey]}]\nset: {b: \"= 2 * $a\"}\n", "5:10", "factor 'a' is 'grey' and stands in an expression"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nconstraints: [\"$a\"]\n", "5:15", "the constraint '$a' is no comparison"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nconstraints: [\"0 < $a < 1\"]\n", "5:15",
       "is no comparison; expected two expressions with <, <=, > or >= between them"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nconstraints: [\"$a < $b\"]\n", "5:15", "there is no factor 'b'"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nconstraints: [\"$a < 3 km\"]\n", "5:15", "cannot be compared"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nconstraints: [\"$a >= 0\", \"$a > 2\"]\n", "5:26",
       "none of 1000 draws of sample 0 meets the constraints"},
      {"samples: 8\ndesign: sobol\nvary: [{name: a, key: a, uniform: [0, 1]}]\nconstraints: [\"$a > 2\"]\n", "6:14",
       "none of the 8 samples meets the constraints"},
      // Tables.
      {"design: table\nvary: [{name: a, key: a}]\n", "3:9", "the design is a table, and none is named"},
      {"samples: 2\ntable: few.csv\nvary: [{name: a, key: a, uniform: [0, 1]}]\n", "4:8", "a table beside another design"},
      {"design: table\ntable: few.csv\nsamples: 1\nvary: [{name: a, key: a}]\n", "5:10", "samples of a table, whose rows they are"},
      {"design: table\ntable: few.csv\nvary: [{name: a, key: a, uniform: [0, 1]}]\n", "5:35", "'uniform' of a factor whose values are in a table"},
      {"design: table\ntable: gone.csv\nvary: [{name: a, key: a}]\n", "4:8", "gone.csv"},
      {"design: table\ntable: few.csv\nvary: [{name: b, key: a}]\n", "few.csv:1:1", "the table has no column of the factor 'b', but 'a'"},
      {"design: table\ntable: nan.csv\nvary: [{name: a, key: a}]\n", "nan.csv:3:1", "not a finite number: 'nan'"},
      {"design: table\ntable: twice.csv\nvary: [{name: a, key: a}]\n", "twice.csv:1:10", "two columns are called 'a'"},
      {"design: table\ntable: none.csv\nvary: [{name: a, key: a}]\n", "none.csv:1:1", "the table has no rows"},
      {"design: table\ntable: unit.csv\nvary: [{name: a, key: a}]\n", "unit.csv:1:3", "there is no unit 'kmm'"},
      {"design: table\ntable: place.csv\nvary: [{name: a, key: a, choice: [x, y]}]\n", "place.csv:3:1",
       "'a' is 2; expected the place of one of its 2 choices, from 0"},
      // Measures.
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nmeasures: [{name: m}]\n", "5:12", "nothing says what the measure is"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nmeasures: [{name: m, truth: jet, value: mw.nsr}]\n", "5:41",
       "the truth table has no column 'mw.nsr'"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nmeasures: [{name: m, statistic: p101, layer: mw.radiance}]\n", "5:33",
       "there is no statistic 'p101'"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nmeasures: [{name: m, statistic: mean, layer: l, region: [0, 0, 0, 1]}]\n", "5:64",
       "a size of 0 pixels"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nmeasures: [{name: a, statistic: mean, layer: l}]\n", "5:12", "two columns are called 'a'"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nmeasures: [{python: n.py, function: f, names: [m]}]\n", "5:21", "there is no file 'n.py'"},
      {"samples: 2\nvary: [{name: a, key: a, uniform: [0, 1]}]\nmeasures: [{python: m.py, function: f, names: [m, n], units: [K]}]\n", "5:62",
       "1 units of 2 names"},
  };
  for (const Mistake& m : mistakes) {
    const std::string message = refusal(head + m.text),
                      place = (std::string(m.place).find(".csv") == std::string::npos ? "sweep.yaml:" : "") + std::string(m.place) + ": ";
    EXPECT_TRUE(message.starts_with(place)) << place << " of\n" << m.text << message;
    EXPECT_NE(message.find(m.part), std::string::npos) << m.part << " in\n" << m.text << message;
    EXPECT_NE(message.find("; expected "), std::string::npos) << message;
    EXPECT_NE(message.find("; fix: "), std::string::npos) << message;
  }
  EXPECT_TRUE(refusal("sweep: a/b\nscenario: scene.yaml\nvary: [1]\n").starts_with("sweep.yaml:1:8: a sweep cannot be called 'a/b'"));
  EXPECT_EQ(refusal("sweep: s\nscenario: gone.yaml\nsamples: 1\nvary: [{name: a, key: a, uniform: [0, 1]}]\n")
                .rfind("sweep.yaml:2:11: there is no file 'gone.yaml'", 0),
            0u);
}

TEST(SweepTables, AreInTheKeyReference) {
  const std::string text = sweepKeyReference();
  for (const char* title : {"### sweep\n", "### factor", "### measure by Python", "| `log_uniform` |"}) EXPECT_NE(text.find(title), std::string::npos) << title;
}

}  // namespace
}  // namespace pitviper::test
