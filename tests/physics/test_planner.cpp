// Plans for a scene and an accuracy: against closed forms, the same every time, kept by content.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "sim/plan/line_check.hpp"
#include "sim/plan/plan_cache.hpp"
#include "sim/plan/planner.hpp"
#include "sim/plan/surroundings_choice.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string camera(const std::string& channels, const std::string& more = "") {
  return "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 2 deg, aperture: 5 mm, position: [0 m, 0 m, 100 m], look_at: [0 m, 1 km, 100 m], "
         "channels: [" +
         channels + "]" + more + "}]\n";
}
const std::string kMidwave = "{name: mw, response: {band: [3 um, 5 um]}}", kLongwave = "{name: lw, response: {band: [8 um, 12 um]}}";
const std::string kWall =
    "entities: [{name: wall, shape: {model: plate, width: 200 m, height: 200 m}, material: m, temperature: 310 K, "
    "position: [0 m, 1 km, 100 m], heading: 180 deg}]\n";
const std::string kGrey = "materials: {m: {components: [{reflection: lambertian, reflectance: 0.2}]}}\n";

Plan planOf(const Simulation& sim) { return planFor(sim, {&sim.cameras.at(0), nullptr}); }

/// A cache of its own for each test, so that plans are really made.
class Planner : public ::testing::Test {
 protected:
  void SetUp() override {
    needContext();  // the driver looks for its own cache once
    if (const char* old = std::getenv("XDG_CACHE_HOME")) before_ = old;
    folder_ = std::filesystem::temp_directory_path() / ("pitviper_plans_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
                                                        ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
  }
  void TearDown() override {
    if (before_.empty()) unsetenv("XDG_CACHE_HOME");
    else setenv("XDG_CACHE_HOME", before_.c_str(), 1);
    std::filesystem::remove_all(folder_);
  }
  size_t kept() const {
    size_t n = 0;
    for (const auto& f : std::filesystem::recursive_directory_iterator(folder_)) n += f.path().filename().string().starts_with("table-plan-");
    return n;
  }
  std::filesystem::path folder_;
  std::string before_;
};

// Nothing that varies over wavelength but the wall's own black body: one group does.
TEST_F(Planner, GreySceneNeedsOneGroup) {
  const auto sim = scene("accuracy: 0.1 %\n" + kGrey + kWall + camera(kMidwave + ", " + kLongwave));
  const Plan plan = planOf(sim);
  ASSERT_EQ(plan.slotCount, 2);
  EXPECT_EQ(plan.nodeCount(), 2);
  for (double e : plan.predictedError) EXPECT_LE(e, 0.001);
  const Frame frame = renderFrame(sim);
  figure("planned grey wall, 3-5 um, one group [W/(m2 sr)]", at(layer(frame, "mw.radiance"), frame, 4, 4), 0.8 * blackBodyBand(3, 5, 310), 1e-3,
         "asked for; series of the Planck integral");
  figure("planned grey wall, 8-12 um, one group [W/(m2 sr)]", at(layer(frame, "lw.radiance"), frame, 4, 4), 0.8 * blackBodyBand(8, 12, 310), 1e-3,
         "asked for; series of the Planck integral");
}

// Two lines, one of which the air does not let through: no mean extinction can stand for both.
TEST_F(Planner, AirThatTellsWavelengthsApartNeedsMore) {
  const std::string air = "atmosphere: {extinction: {wavelength: um, unit: 1/m, values: [[3, 0], [3.99, 0], [4.01, 0.004], [5, 0.004]]}, temperature: 290 K}\n";
  // From one place a single mean does; between 0.1 and 1 km none can.
  EXPECT_EQ(planOf(scene("accuracy: 1 %\n" + air + kGrey + kWall + camera(kMidwave))).nodeCount(), 1);
  std::string moving = camera(kMidwave);
  const std::string still = "position: [0 m, 0 m, 100 m]";
  moving.replace(moving.find(still), still.size(), "motion: [{time: 0 s, position: [0 m, 0 m, 100 m]}, {time: 9 s, position: [0 m, 900 m, 100 m]}]");
  const auto sim = scene("accuracy: 1 %\ntime: {rate: 1 Hz, frames: 10}\n" + air + kGrey + kWall + moving);
  const Plan plan = planOf(sim);
  EXPECT_GE(plan.nodeCount(), 2);
  EXPECT_LE(plan.nodeCount(), 6);
  EXPECT_LE(plan.predictedError.at(0), 0.01);
  const Frame frame = renderFrame(sim);
  auto through = [&](double low, double high, double tau) { return 0.8 * tau * blackBodyBand(low, high, 310) + (1 - tau) * blackBodyBand(low, high, 290); };
  figure("planned wall through air with an edge [W/(m2 sr)]", at(layer(frame, "mw.radiance"), frame, 4, 4), through(3, 4, 1) + through(4, 5, std::exp(-4.0)),
         1e-2, "asked for; Beer-Lambert on either side of 4 um, the ramp of 0.02 um as a step");
}

TEST_F(Planner, DropsWhatNoChannelSees) {
  const std::string sun = "sun: {azimuth: 180 deg, elevation: 30 deg, temperature: 5772 K}\n";
  const Plan both = planOf(scene("accuracy: 1 %\n" + sun + kGrey + kWall + camera(kMidwave + ", " + kLongwave)));
  EXPECT_TRUE(both.terms.lights);
  ASSERT_EQ(both.blocks.size(), 2u);
  EXPECT_TRUE(both.blocks[0].lit);
  const Plan far = planOf(scene("accuracy: 10 %\n" + sun + kGrey + kWall + camera(kLongwave)));
  EXPECT_FALSE(far.terms.lights) << "0.1 % of sunlight at 8 to 12 um is far below 10 %";
  EXPECT_FALSE(far.terms.shadows);
  EXPECT_EQ(far.lightCount, 0);
  EXPECT_TRUE(planOf(scene("accuracy: 0.1 %\n" + sun + kGrey + kWall + camera(kLongwave))).terms.lights);
}

// A mirror's sky is more than harmonics can tell: that is said, and wavelengths are spent on what wavelengths are off by alone.
TEST_F(Planner, WhatHarmonicsLoseTakesNoWavelengths) {
  const std::string sky =
      "atmosphere: clear_us76\nsun: {azimuth: 200 deg, elevation: 40 deg, temperature: 5772 K}\nambient: {from: sky}\n"
      "ground: {material: soil, temperature: 295 K}\n";
  const Plan plan =
      planOf(scene("accuracy: 0.5 %\n" + sky +
                   "materials: {m: {components: [{reflection: microfacet, index: aluminium, roughness: 0.01}]}}\n"
                   "entities: [{name: b, shape: {model: sphere, radius: 20 m}, material: m, temperature: 300 K, position: [0 m, 1 km, 100 m]}]\n" +
                   camera("{name: vis, response: {band: [0.5 um, 0.54 um]}}")));
  ASSERT_EQ(plan.parts.size(), 1u);
  EXPECT_GT(plan.parts[0].surroundings, 0.005) << "or the scene says nothing";
  EXPECT_LE(plan.parts[0].wavelengths, 0.005);
  EXPECT_LE(plan.nodeCount(), 2) << "so smooth a band takes one or two; held against lines with more harmonics than its own it took five";
}

TEST_F(Planner, SamePlanEveryTimeAndFromTheCache) {
  const std::string text = "accuracy: 1 %\natmosphere: clear_us76\n" + kGrey + kWall + camera(kMidwave);
  const Plan first = planOf(scene(text));
  EXPECT_EQ(kept(), 1u);
  const Plan again = planOf(scene(text));
  EXPECT_EQ(writePlanned(first), writePlanned(again));
  EXPECT_EQ(kept(), 1u);
  std::filesystem::remove_all(folder_);
  EXPECT_EQ(writePlanned(planOf(scene(text))), writePlanned(first)) << "made anew";
  // Whatever a plan depends on makes another one.
  for (const auto& [from, to] : {std::pair{"310 K", "311 K"},
                                 {"reflectance: 0.2", "reflectance: 0.21"},
                                 {"1 km, 100 m], heading", "1.1 km, 100 m], heading"},
                                 {"clear_us76", "hazy_us76"},
                                 {"accuracy: 1 %", "accuracy: 2 %"},
                                 {"5 um", "5.1 um"}}) {
    std::string other = text;
    other.replace(other.find(from), std::string(from).size(), to);
    const size_t before = kept();
    planOf(scene(other));
    EXPECT_EQ(kept(), before + 1) << to;
  }
}

const std::string kEye = ", exposure: 2 ms, stages: [{stage: detector, full_well: 7e6, bits: 14, read_noise: 500}]";
std::string counting(const std::string& outputs) {
  return "{name: mw, response: {band: [3.7 um, 4.9 um]}, quantum_efficiency: insb_mwir, output: [" + outputs + "]}";
}

// Radiance and what a detector counts of it are integrals over one band: the groups of one do for the other, or nearly.
TEST_F(Planner, QuantitiesOfOneBandShareGroups) {
  const std::string world = "atmosphere: clear_us76\nsun: {azimuth: 200 deg, elevation: 40 deg, temperature: 5772 K}\nambient: {from: sky}\n" + kGrey + kWall;
  const auto made = [&](const std::string& accuracy, const std::string& outputs) {
    return scene("accuracy: " + accuracy + "\n" + world + camera(counting(outputs), kEye));
  };
  const auto sim = made("0.5 %", "radiance, electrons");
  const Plan plan = planOf(sim);
  ASSERT_EQ(plan.slotCount, 2);
  ASSERT_EQ(plan.blocks.size(), 1u);
  EXPECT_EQ(plan.blocks[0].slots, (std::vector<int>{0, 1}));
  const int alone = planOf(made("0.5 %", "radiance")).nodeCount() + planOf(made("0.5 %", "electrons")).nodeCount();
  EXPECT_LT(plan.nodeCount(), alone);
  const Frame planned = renderFrame(sim), exact = renderFrame(made("reference", "radiance, electrons"));
  for (const char* quantity : {"mw.radiance", "mw.electrons"}) {
    double worst = 0.0;
    const FrameLayer &a = layer(planned, quantity), &b = layer(exact, quantity);
    for (size_t p = 0; p < a.pixels.size(); ++p) worst = std::max(worst, std::abs(static_cast<double>(a.pixels[p]) / static_cast<double>(b.pixels[p]) - 1.0));
    bound(std::string(quantity) + " by groups of both in common against all wavelengths", worst, 0.005, "asked for");
  }
  // The reference tells both at the same wavelengths, each with its own weights.
  SpectralSampling every;
  every.reference = true;
  const Plan fine = makePlan(sim, sim.cameras[0].outputs, every, sim.cameras[0].where);
  ASSERT_EQ(fine.blocks.size(), 1u);
  for (size_t s = 0; s < 2; ++s) {
    const Spectrum& kernel = sim.cameras[0].outputs[s].kernel;
    double sum = 0.0;
    for (double w : fine.weight[s]) sum += w;
    figure("sum of the weights of kernel " + std::to_string(s), sum, kernel.integral(3.7, 4.9), 1e-12, "its integral over the band");
  }
}

// Of targets' truth nothing is planned for itself: their channels are planned with the picture's.
TEST_F(Planner, TruthOfTargetsTakesThePicturesGroups) {
  const auto sim = scene("accuracy: 1 %\natmosphere: clear_us76\n" + kGrey + kWall + camera(counting("counts"), kEye + ", truth: [targets]"));
  const Plan drawn = planOf(sim);
  const Plan measured = measuredPlanFor(sim, sim.cameras[0]);
  EXPECT_EQ(kept(), 1u);
  EXPECT_EQ(drawn.slotCount, 1);
  ASSERT_EQ(measured.slotCount, 2);
  ASSERT_EQ(drawn.nodeCount(), measured.nodeCount());
  for (int i = 0; i < drawn.nodeCount(); ++i) {
    const auto k = static_cast<size_t>(i);
    ASSERT_EQ(drawn.nodes[k].members.size(), measured.nodes[k].members.size());
    EXPECT_EQ(drawn.weight[0][k], measured.weight[static_cast<size_t>(measured.slotOfOutput[1])][k]) << "of what is counted";
  }
  ASSERT_EQ(measured.predictedError.size(), 2u);
  for (double e : measured.predictedError) EXPECT_LE(e, 0.01);
}

// How long a camera is exposed, what its detector makes of light, and what is shown besides are no matter to wavelengths.
TEST_F(Planner, WhatComesAfterLightPlansNothingAnew) {
  const std::string text = "accuracy: 1 %\natmosphere: clear_us76\n" + kGrey + kWall + camera(counting("counts, radiance"), kEye);
  planOf(scene(text));
  ASSERT_EQ(kept(), 1u);
  for (const auto& [from, to] : {std::pair{"2 ms", "3 ms"},
                                 {"read_noise: 500", "read_noise: 700"},
                                 {"counts, radiance", "counts, snr, radiance"},
                                 {"read_noise: 500}]", "read_noise: 500}], truth: [range, entity]"}}) {
    std::string other = text;
    other.replace(other.find(from), std::string(from).size(), to);
    planOf(scene(other));
    EXPECT_EQ(kept(), 1u) << to;
  }
  std::string other = text;
  other.replace(other.find("counts, radiance"), 16, "radiance");
  planOf(scene(other));
  EXPECT_EQ(kept(), 2u) << "one kernel less";
}

TEST_F(Planner, DamagedPlansAreNotRead) {
  const auto sim = scene("accuracy: 1 %\n" + kGrey + kWall + camera(kMidwave));
  const Plan plan = planOf(sim);
  const std::string text = writePlanned(plan);
  Plan read = makePlan(sim, sim.cameras[0].outputs, sim.cameras[0].spectral, sim.cameras[0].where);
  read.accuracy = plan.accuracy;  // which the outline says, and with it which tables there are
  const int nodes = read.nodeCount();
  ASSERT_NE(nodes, plan.nodeCount());
  for (size_t k = 0; k < text.size(); k += 1 + text.size() / 200) {
    std::string bad = text;
    bad[k] = bad[k] == '7' ? '3' : '7';
    EXPECT_FALSE(readPlanned(bad, read)) << k;
    EXPECT_FALSE(readPlanned(text.substr(0, k), read)) << k;
  }
  EXPECT_EQ(read.nodeCount(), nodes) << "left as it was";
  EXPECT_TRUE(readPlanned(text, read));
  EXPECT_EQ(writePlanned(read), text);
}

// Groups of wavelengths whose surroundings and black bodies are known take theirs from these: the same light as worked out anew.
TEST_F(Planner, NodesOfKnownWavelengthsAreAveragesOfThem) {
  const auto sim = scene(
      "accuracy: 1 %\natmosphere: clear_us76\nsun: {azimuth: 200 deg, elevation: 40 deg, temperature: 5772 K}\nambient: {from: sky}\n"
      "plumes: [{name: p, position: [-5 m, 900 m, 100 m], direction: [1, 0, 0], engine: turbofan_military, length: 20 m, begin: -1 s}]\n" +
      kGrey + kWall + camera("{name: mw, response: {band: [4 um, 4.6 um]}}, {name: lw, response: {band: [8 um, 10 um]}}"));
  const Camera& camera = sim.cameras.at(0);
  const Plan plan = planOf(sim);
  SpectralSampling every;
  every.reference = true;
  Plan exact = makePlan(sim, camera.outputs, every, camera.where);
  exact.terms = withSurroundings(exact.terms, plan.terms.surroundings);
  const NodesOfPlan fine(sim, exact), anew(sim, plan), averaged(sim, plan, &fine);
  SightRays rays(sim, {&camera, nullptr}, 7);
  std::vector<SightRay> lines;
  for (int n = 0; n < 40; ++n) lines.push_back(rays.ofCombination());
  HeldLines held(sim, fine, lines, kUsualPlaces, filmFloors(sim, fine, rays));
  const auto a = held.check(anew), b = held.check(averaged);
  ASSERT_EQ(a.size(), 2u);
  double worst = 0.0, largest = 0.0;
  for (size_t s = 0; s < a.size(); ++s)
    for (size_t n = 0; n < lines.size(); ++n) {
      worst = std::max(worst, std::abs(a[s].errors[n] - b[s].errors[n]));
      largest = std::max(largest, a[s].errors[n]);
    }
  EXPECT_GT(largest, 1e-5) << "there is something to compare";
  bound("light along 40 lines by nodes averaged from known wavelengths against nodes made anew", worst, 1e-4,
        "patterns leave 1e-5 of a node's norm out, on each side");
}

// How bright a film is, and what harmonics lose, is told on few wavelengths of a channel: as all of them tell it.
TEST_F(Planner, FewWavelengthsTellFloorsAndHarmonics) {
  const auto sim = scene("accuracy: 1 %\natmosphere: clear_us76\nsun: {azimuth: 200 deg, elevation: 40 deg, temperature: 5772 K}\nambient: {from: sky}\n" +
                         kGrey + kWall + camera("{name: vis, response: {band: [0.5 um, 0.54 um]}}, " + kMidwave + ", " + kLongwave));
  const Camera& camera = sim.cameras.at(0);
  SpectralSampling every;
  every.reference = true;
  Plan all = makePlan(sim, camera.outputs, every, camera.where);
  all.terms = withSurroundings(all.terms, Terms::kWhole);
  const Plan few = someWavelengths(all, 16);
  ASSERT_EQ(few.nodeCount(), 3 * 16);
  ASSERT_GT(all.nodeCount(), 4 * few.nodeCount());
  std::vector<std::vector<double>> floors, losses;
  for (const Plan* of : std::initializer_list<const Plan*>{&all, &few}) {
    const NodesOfPlan nodes(sim, *of);
    SightRays rays(sim, {&camera, nullptr}, 7);
    floors.push_back(filmFloors(sim, nodes, rays));
    Plan chosen = *of;
    chosen.accuracy = 1e-3;
    chooseSurroundings(sim, nodes, rays, floors.back(), chosen);
    losses.push_back(chosen.surroundingsLoss);
    EXPECT_EQ(losses.back().size(), 3u);
  }
  double floor = 0.0, loss = 0.0, largest = 0.0;
  for (size_t s = 0; s < 3; ++s) {
    double whole = 0.0, some = 0.0;
    for (double w : all.weight[s]) whole += w;
    for (double w : few.weight[s]) some += w;
    EXPECT_NEAR(some / whole, 1.0, 1e-12) << "no part of a response is lost";
    floor = std::max(floor, std::abs(floors[1][s] / floors[0][s] - 1.0));
    loss = std::max(loss, std::abs(losses[1][s] - losses[0][s]));
    largest = std::max(largest, losses[0][s]);
  }
  EXPECT_GT(largest, 1e-6) << "there is something to compare";
  bound("floors of a film in three bands by 16 wavelengths against all", floor, 0.05,
        "a floor is a thousandth of the film's brightness: a twentieth of it is nothing");
  bound("what harmonics lose by 16 wavelengths against all, of that, largest", loss / largest, 0.1,
        "it is predicted with parts beside it that have a margin of 2");
}

}  // namespace
}  // namespace pitviper::test
