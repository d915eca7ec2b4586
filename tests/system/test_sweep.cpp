// Sweeps as a user runs them: the same table however it was come by, stops and goes on, parts, sinks, Python, solving, mistakes.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "sim/frame/read_frame.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

/// A warm ball before a cold wall of sky, a detector with noise.
const char* const kScene =
    "accuracy: 1 %\n"
    "limits: {range: [20 m, 500 m], temperature: [250 K, 400 K]}\n"
    "background: {temperature: 270 K}\n"
    "materials: {black: {components: [{reflection: lambertian, reflectance: 0.1}]}}\n"
    "entities: [{name: ball, shape: {model: sphere, radius: 1 m}, material: black, temperature: 300 K, position: [0 m, 100 m, 0 m]}]\n"
    "cameras:\n"
    "  - name: cam\n"
    "    position: [0 m, 0 m, 0 m]\n"
    "    look_at: ball\n"
    "    film: {width: 24, height: 16}\n"
    "    samples: 4\n"
    "    field_of_view: 6 deg\n"
    "    aperture: 20 mm\n"
    "    exposure: 0.02 ms\n"
    "    truth: [range, entity, temperature, targets]\n"
    "    channels: [{name: mw, response: {band: [3.7 um, 4.8 um]}, quantum_efficiency: 0.8, output: [counts, radiance]}]\n"
    "    stages: [{stage: detector, full_well: 5e6, bits: 14, read_noise: 500}]\n";

std::string sweepText(int samples, const std::string& more = "") {
  return "sweep: ball\nscenario: scene.yaml\nseed: 5\nsamples: " + std::to_string(samples) +
         "\ndesign: random\n"
         "vary:\n"
         "  - {name: range, log_uniform: [30 m, 400 m]}\n"
         "  - {name: temperature, key: entities.ball.temperature, normal: {mean: 310 K, sigma: 10 K}, within: [280 K, 340 K]}\n"
         "set: {entities.ball.position: [0 m, $range, 0 m]}\n"
         "measures:\n"
         "  - {name: seen, truth: ball, value: range}\n"
         "  - {name: intensity, truth: ball, value: mw.own}\n"
         "  - {name: counts, statistic: mean, layer: mw.counts}\n" +
         more;
}

class SweepCommand : public ::testing::Test {
 protected:
  void SetUp() override { write("scene.yaml", kScene); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_.path() / name) << text; }
  std::string text(const std::string& name) const {
    std::ifstream file(folder_.path() / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::string line(const std::string& arguments) const {
    return "cd " + folder_.path().string() + " && XDG_CACHE_HOME=" + (folder_.path() / "cache").string() + " PITVIPER_HOME=" + PITVIPER_SOURCE_DIR + " " +
           PITVIPER_PROGRAM + " sweep " + arguments;
  }
  Result sweep(const std::string& arguments) const { return test::run(line(arguments)); }
  /// Cells of a table's rows, header first.
  std::vector<std::vector<std::string>> table(const std::string& name) const {
    std::vector<std::vector<std::string>> rows;
    std::istringstream in(text(name));
    for (std::string l; std::getline(in, l);) {
      rows.emplace_back();
      std::istringstream cells(l);
      for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
  }
  TemporaryFolder folder_;
};

TEST_F(SweepCommand, TheTableIsTheSameHoweverItIsComeBy) {
  write("s.yaml", sweepText(30));
  ASSERT_EQ(sweep("s.yaml --out one --workers 1").code, 0);
  const std::string one = text("one/sweep.csv");
  ASSERT_FALSE(one.empty());
  const Result two = sweep("s.yaml --out two --workers 3");
  EXPECT_EQ(two.code, 0) << two.output;
  EXPECT_EQ(text("two/sweep.csv"), one);
  for (int part : {2, 0, 1}) EXPECT_EQ(sweep("s.yaml --out parts --workers 1 --part " + std::to_string(part) + "/3").code, 0);
  const Result merged = sweep("s.yaml --out parts --merge");
  EXPECT_EQ(merged.code, 0) << merged.output;
  EXPECT_EQ(text("parts/sweep.csv"), one);
  // A sample alone: of a sweep that has only its part drawn.
  EXPECT_EQ(sweep("s.yaml --out few --workers 1 --part 7/30").code, 0);
  const Result lacking = sweep("s.yaml --out few --merge");
  EXPECT_EQ(lacking.code, 0) << lacking.output;
  EXPECT_NE(lacking.output.find("29 samples are not drawn yet"), std::string::npos) << lacking.output;
  const auto few = table("few/sweep.csv"), all = table("one/sweep.csv");
  ASSERT_EQ(few.size(), 2u);
  EXPECT_EQ(few[1], all[8]);
}

TEST_F(SweepCommand, MeasuresWhatIsThere) {
  write("measures.py",
        "def both(frame, sample):\n"
        "    mask = frame['truth.entity'] > 0\n"
        "    print('printing is harmless')\n"
        "    return frame['mw.radiance'].max(), mask.sum()\n");
  write("s.yaml", sweepText(12, "  - {python: measures.py, function: both, names: [peak, pixels], units: ['W/(m2 sr)', '1']}\n"));
  const Result r = sweep("s.yaml --out out --workers 2");
  ASSERT_EQ(r.code, 0) << r.output;
  const auto rows = table("out/sweep.csv");
  ASSERT_EQ(rows.size(), 13u);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"sample", "seed", "range [m]", "temperature [K]", "seen [m]", "intensity [W/sr]", "counts [count]",
                                               "peak [W/(m2 sr)]", "pixels [1]", "predicted_error [1]", "outside_limits [1]", "why"}));
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const auto at = [&](std::size_t c) { return std::stod(rows[k][c]); };
    // Table of targets and factor are the same number.
    EXPECT_NEAR(at(4), at(2), 1e-9 * at(2));
    // A ball of 1 m and emissivity 0.9 that reflects a dark surround: own intensity is 0.9 pi L(T); L within the accuracy asked.
    const double T = at(3), low = 3.7, high = 4.8;
    double L = 0.0;
    constexpr int n = 4000;
    for (int i = 0; i < n; ++i) {
      const double w = low + (high - low) * (i + 0.5) / n;
      L += 1.191042972e8 / (std::pow(w, 5) * (std::exp(14387.76877 / (w * T)) - 1.0)) * (high - low) / n;
    }
    EXPECT_NEAR(at(5) / (0.9 * 3.14159265358979 * L), 1.0, 0.01) << "at " << T << " K";
    EXPECT_GE(at(8), 1.0);
  }
  EXPECT_NE(text("out/sweep.html").find("<svg"), std::string::npos);
}

// One plan for many: towards the sun and away from it, near and far, in two kinds of haze, each sample against every wavelength in double precision.
TEST_F(SweepCommand, SamplesKeepTheAccuracyAsked) {
  write("air.yaml",
        "accuracy: 1 %\n"
        "limits: {range: [200 m, 5 km], temperature: [250 K, 400 K]}\n"
        "atmosphere: clear_us76\n"
        "sun: {azimuth: 150 deg, elevation: 40 deg, temperature: 5772 K}\n"
        "materials: {grey: {components: [{reflection: lambertian, reflectance: 0.4}]}}\n"
        "entities: [{name: ball, shape: {model: sphere, radius: 6 m}, material: grey, temperature: 300 K, position: [0 m, 1 km, 100 m]}]\n"
        "cameras:\n"
        "  - {name: cam, position: [0 m, 0 m, 10 m], look_at: ball, film: {width: 8, height: 8}, samples: 1, field_of_view: 2 deg, aperture: 20 mm, exposure: "
        "1 ms,\n"
        "     channels: [{name: mw, response: {band: [3.7 um, 4.2 um]}}]}\n");
  write("s.yaml",
        "sweep: air\nscenario: air.yaml\nsamples: 40\ndesign: latin_hypercube\n"
        "vary:\n"
        "  - {name: range, log_uniform: [400 m, 4 km]}\n"
        "  - {name: aspect, uniform: [0 deg, 360 deg]}\n"
        "  - {name: skin, key: entities.ball.temperature, uniform: [280 K, 350 K]}\n"
        "  - {name: haze, values: [6 km, 40 km]}\n"
        "set:\n"
        "  atmosphere: {library: clear_us76, aerosol: rural, visibility: $haze}\n"
        "  entities.ball.position: [\"= $range * sin($aspect)\", \"= $range * cos($aspect)\", \"= 0.3 * $range\"]\n"
        "measures:\n"
        "  - {name: sky, statistic: min, layer: mw.radiance}\n"
        "  - {name: corner, statistic: mean, layer: mw.radiance, region: [0, 0, 1, 1]}\n"
        "  - {name: middle, statistic: mean, layer: mw.radiance, region: [4, 4, 1, 1]}\n");
  const Result r = sweep("s.yaml --out out --workers 2");
  ASSERT_EQ(r.code, 0) << r.output;
  const auto rows = table("out/sweep.csv");
  ASSERT_EQ(rows.size(), 41u);
  double worst = 0.0;
  for (std::size_t k = 1; k < rows.size(); k += 10) {
    const double range = 1.0 * std::stod(rows[k][2]), a = std::stod(rows[k][3]) * 3.14159265358979323846 / 180.0;
    std::ostringstream set;
    set.precision(17);
    set << " --set accuracy=reference --set 'atmosphere={library: clear_us76, aerosol: rural, visibility: " << rows[k][5]
        << " km}' --set entities.ball.temperature='" << rows[k][4] << " K' --set entities.ball.position='[" << range * std::sin(a) << " m, "
        << range * std::cos(a) << " m, " << 0.3 * range << " m]'";
    const Result ran = test::run("cd " + folder_.path().string() + " && XDG_CACHE_HOME=" + (folder_.path() / "cache").string() +
                                 " PITVIPER_HOME=" + PITVIPER_SOURCE_DIR + " " + PITVIPER_PROGRAM + " run air.yaml --overwrite --out exact" + set.str());
    ASSERT_EQ(ran.code, 0) << ran.output;
    const auto pixels = readFrame(folder_.path() / "exact/cam_00000.exr").layers[0].pixels;
    for (const auto& [column, pixel] : {std::pair{7u, 0u}, std::pair{8u, 36u}}) {
      const double exact = static_cast<double>(pixels[pixel]), off = std::abs(std::stod(rows[k][column]) / exact - 1.0);
      EXPECT_LE(off, 0.01) << "sample " << rows[k][0] << ", " << rows[0][column];
      worst = std::max(worst, off);
    }
  }
  bound("samples of a sweep drawn by shared plans at 1 %, sky and body, worst of 8", worst, 0.01, "asked for");
}

TEST_F(SweepCommand, GoesOnWhereItWasKilled) {
  write("s.yaml", sweepText(60));
  ASSERT_EQ(sweep("s.yaml --out whole").code, 0);
  int stopped = 0;
  for (int round = 0; round < 4; ++round) {
    const pid_t child = fork();
    if (child == 0) {
      setsid();
      execl("/bin/sh", "sh", "-c", (line("s.yaml --out cut --workers 2") + " >/dev/null 2>&1").c_str(), nullptr);
      _exit(127);
    }
    // Each round is let get a little farther, by what is stored, not by the clock.
    const std::size_t wanted = static_cast<std::size_t>(round + 1) * 8;
    const auto stored = [&] {
      const Result r = test::run("sqlite3 " + (folder_.path() / "cut/sweep.sqlite").string() + " 'select count(*) from samples' 2>/dev/null");
      return static_cast<std::size_t>(std::atoi(r.output.c_str()));
    };
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0 && stored() < wanted) usleep(20000);
    stopped += kill(-child, SIGKILL) == 0;
    waitpid(child, &status, 0);
  }
  EXPECT_GT(stopped, 0);
  const Result r = sweep("s.yaml --out cut --workers 2");
  EXPECT_EQ(r.code, 0) << r.output;
  EXPECT_EQ(text("cut/sweep.csv"), text("whole/sweep.csv"));
}

TEST_F(SweepCommand, FeedsDataSets) {
  write("s.yaml",
        sweepText(10, "sinks: [{sink: coco, categories: {ball: target}, split: {train: 0.6, val: 0.4}, folder: coco}, {sink: truth, folder: table}]\n"));
  const Result r = sweep("s.yaml --out out --workers 2");
  ASSERT_EQ(r.code, 0) << r.output;
  int images = 0;
  for (const char* part : {"train", "val"}) {
    const std::string json = text(std::string("out/coco/annotations_") + part + ".json");
    for (std::size_t at = 0; (at = json.find("\"file_name\"", at)) != std::string::npos; ++at) ++images;
  }
  EXPECT_EQ(images, 10);
  const Frame frame = readFrame(folder_.path() / "out/frames/cam_00003.exr");
  ASSERT_EQ(frame.targets.size(), 1u);
  EXPECT_EQ(frame.targets[0].name, "ball");
  EXPECT_EQ(frame.targets[0].kind, "body");
  EXPECT_NEAR(frame.targets[0].range_m, std::stod(table("out/sweep.csv")[4][2]), 1e-6);
  EXPECT_EQ(table("out/table/cam_truth.csv").size(), 10u + 2u);  // a line that says whose it is, and the header
}

TEST_F(SweepCommand, Solves) {
  write("s.yaml", sweepText(8));
  // The range at which the range is 123.4 m.
  const Result exact = sweep("s.yaml --solve 'seen = 123.4' --over range");
  EXPECT_EQ(exact.code, 0) << exact.output;
  EXPECT_NE(exact.output.find("at range = 123.4"), std::string::npos) << exact.output;
  const Result none = sweep("s.yaml --solve 'seen = 1000' --over range");
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.output.find("30"), std::string::npos) << none.output;  // says what it is at the ends
  EXPECT_EQ(sweep("s.yaml --solve 'sen = 5' --over range").code, 2);
  EXPECT_EQ(sweep("s.yaml --solve 'seen = 5' --over rnge").code, 2);
}

TEST_F(SweepCommand, SaysWhatWasNotPlannedFor) {
  std::string far = sweepText(8);
  far.replace(far.find("within: [280 K, 340 K]"), 22, "within: [390 K, 420 K]");
  far.replace(far.find("mean: 310 K"), 11, "mean: 401 K");
  write("s.yaml", far);
  const Result r = sweep("s.yaml --out out --workers 1");
  ASSERT_EQ(r.code, 0) << r.output;
  int outside = 0;
  for (const auto& row : table("out/sweep.csv")) outside += row.size() > 8 && row[8] == "1";
  EXPECT_GT(outside, 0);
  EXPECT_LT(outside, 8);
  EXPECT_NE(r.output.find(std::to_string(outside) + " of 8 samples show what is beyond the scenario's 'limits'"), std::string::npos) << r.output;
}

TEST_F(SweepCommand, MistakesAreOneLineAndLoseNothing) {
  write("s.yaml", sweepText(6));
  ASSERT_EQ(sweep("s.yaml --out out --workers 1").code, 0);
  const std::string before = text("out/sweep.csv");
  const auto refused = [&](const std::string& arguments, const std::string& says) {
    const Result r = sweep(arguments);
    EXPECT_EQ(r.code, 2) << arguments << "\n" << r.output;
    EXPECT_NE(r.output.find(says), std::string::npos) << arguments << "\n" << r.output;
    EXPECT_EQ(std::count(r.output.begin(), r.output.end(), '\n'), 1) << r.output;
  };
  write("other.yaml", sweepText(7));
  refused("other.yaml --out out", "sweep.sqlite");
  std::string wrong = sweepText(6);
  write("key.yaml", wrong.replace(wrong.find("entities.ball.temperature"), 25, "entities.ball.temprature"));
  refused("key.yaml --out key", "temprature");
  write("layer.yaml", sweepText(6, "  - {name: x, statistic: mean, layer: lw.counts}\n"));
  refused("layer.yaml --out layer", "layer.yaml:14");
  write("python.yaml", sweepText(6, "  - {python: none.py, function: f, names: [a]}\n"));
  refused("python.yaml --out python", "none.py");
  write("bad.py", "def f(frame, sample):\n    return frame['nothing'].mean()\n");
  write("bad.yaml", sweepText(6, "  - {python: bad.py, function: f, names: [a]}\n"));
  const Result failed = sweep("bad.yaml --out bad --workers 2");
  EXPECT_EQ(failed.code, 2) << failed.output;  // not one sample could be measured
  EXPECT_NE(failed.output.find("line 2: KeyError"), std::string::npos) << failed.output;
  refused("s.yaml --out out --part 3/3", "--part 3/3");
  refused("s.yaml --out out --merge", "no parts");
  refused("missing.yaml", "missing.yaml");
  EXPECT_EQ(text("out/sweep.csv"), before);
}

}  // namespace
}  // namespace pitviper::test
