// The promise of `accuracy`, on random scenarios: no pixel is farther from the reference than was asked, and what a plan predicts is worth its name.
//   PITVIPER_PROMISE=1000            so many scenarios (6 unless given)
//   PITVIPER_PROMISE_SEED=5000       first seed
//   PITVIPER_PROMISE_ACCURACY=10,1   in per cent (1 for all and 10 and 0.1 for every third unless given)
//   PITVIPER_PROMISE_WAVELENGTHS=N   bands are narrowed until a reference has so many at most (150 unless given; 0: as they are drawn)
//   PITVIPER_PROMISE_FIELDS=0        none with plumes, smokes or flares (1 unless given)
//   PITVIPER_PROMISE_FILES=a.yaml:b.yaml   these scenarios instead
//   PITVIPER_PROMISE_AUTO=N          scenarios drawn with samples: auto (4 unless given)
//   PITVIPER_PROMISE_KEEP=FOLDER     for the scenarios as they are drawn (nowhere unless given)
//   PITVIPER_PROMISE_OUT=FOLDER      for promise.csv, promise.md and the scenarios of broken promises (the build folder unless given)
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "sim/parameters/error.hpp"
#include "tests/promise/promise_report.hpp"
#include "tests/promise/random_scenario.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/long_tests.hpp"

namespace pitviper::test {
namespace {

/// What a clone without settings tries.
constexpr int kScenarios = 6, kWavelengths = 150, kAttempts = 20;
constexpr std::uint64_t kSeed = 3;
/// Of these, one that the reference takes as long for as for all others together: tried where long tests are asked for.
constexpr std::uint64_t kLongSeed = 7;
constexpr long long kFields = 1;

std::string setting(const char* name) {
  const char* text = std::getenv(name);
  return text ? text : "";
}
long long number(const char* name, long long otherwise) {
  const std::string text = setting(name);
  return text.empty() ? otherwise : std::atoll(text.c_str());
}
std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

std::vector<double> accuracies(int scene) {
  if (const auto given = split(setting("PITVIPER_PROMISE_ACCURACY"), ','); !given.empty()) {
    std::vector<double> all;
    for (const auto& g : given) all.push_back(0.01 * std::atof(g.c_str()));
    return all;
  }
  return scene % 3 == 0 ? std::vector<double>{0.1, 0.01, 0.001} : std::vector<double>{0.01};
}

int mostWavelengths() {
  const auto given = number("PITVIPER_PROMISE_WAVELENGTHS", kWavelengths);
  return given > 0 ? static_cast<int>(given) : ScenarioDraw{}.mostWavelengths;
}

/// A scenario of a seed that the reader accepts.
PromiseScene sceneOf(std::uint64_t seed, const std::vector<double>& asked, bool automatic = false) {
  for (int attempt = 0;; ++attempt) {
    const std::string text = randomScenario({seed, attempt, mostWavelengths(), number("PITVIPER_PROMISE_FIELDS", kFields) > 0});
    if (const std::string kept = setting("PITVIPER_PROMISE_KEEP"); !kept.empty())
      std::ofstream(std::filesystem::path(kept) / (std::to_string(seed) + ".yaml")) << text;
    try {
      return keepPromise(seed, text, asked, automatic);
    } catch (const UserError& e) {
      std::fprintf(stderr, "seed %llu, attempt %d: refused: %s\n", static_cast<unsigned long long>(seed), attempt, e.what());
      if (attempt + 1 == kAttempts) throw;
    }
  }
}

struct Run {
  std::vector<PromiseScene> scenes;
  std::vector<PromiseCell> cells;
};

Run runAll() {
  Run run;
  const std::filesystem::path out =
      setting("PITVIPER_PROMISE_OUT").empty() ? std::filesystem::path(PITVIPER_BUILD_DIR) : std::filesystem::path(setting("PITVIPER_PROMISE_OUT"));
  std::filesystem::create_directories(out);
  std::ofstream csv(out / "promise.csv");
  csv << promiseCsvHeading() << std::flush;
  const auto files = split(setting("PITVIPER_PROMISE_FILES"), ':');
  const int count = files.empty() ? static_cast<int>(number("PITVIPER_PROMISE", kScenarios)) : static_cast<int>(files.size());
  const auto first = static_cast<std::uint64_t>(number("PITVIPER_PROMISE_SEED", static_cast<long long>(kSeed)));
  for (int k = 0; k < count; ++k) {
    const std::uint64_t seed = first + static_cast<std::uint64_t>(k);
    if (seed == kLongSeed && files.empty() && setting("PITVIPER_PROMISE").empty() && !runsLong()) continue;
    PromiseScene scene;
    if (files.empty()) {
      scene = sceneOf(seed, accuracies(k));
    } else {
      std::ifstream in(files[static_cast<size_t>(k)]);
      scene = keepPromise(seed, std::string(std::istreambuf_iterator<char>(in), {}), accuracies(0));
    }
    csv << promiseCsv(scene) << std::flush;
    double worst = 0.0;
    for (const PromiseCell& c : scene.cells) worst = std::max(worst, c.found / c.asked);
    std::fprintf(stderr, "promise %d of %d: seed %llu: found / asked at most %.3g; reference %.1f s, planned %.1f s\n", k + 1, count,
                 static_cast<unsigned long long>(seed), worst, scene.reference_s, scene.planned_s);
    if (files.empty() && (worst > 1.0 || scene.negative > 0)) {
      std::filesystem::create_directories(out / "promise_broken");
      std::ofstream(out / "promise_broken" / (std::to_string(seed) + ".yaml")) << scene.text;
    }
    run.cells.insert(run.cells.end(), scene.cells.begin(), scene.cells.end());
    run.scenes.push_back(std::move(scene));
  }
  const std::string table = promiseTable(promiseFigures(run.cells));
  std::ofstream(out / "figures_promise.md") << table;
  std::printf("%s", table.c_str());
  return run;
}

const Run& theRun() {
  static const Run run = runAll();
  return run;
}

TEST(Promise, NoPixelIsFartherFromTheReferenceThanAsked) {
  int compared = 0;
  for (const PromiseScene& s : theRun().scenes) compared += s.pixels;
  for (const PromiseCell& c : theRun().cells)
    EXPECT_LE(c.found, c.asked) << "seed " << c.seed << ", " << c.channel << ", frame " << c.worst.frame << ", pixel " << c.worst.column << ", " << c.worst.row
                                << ": " << c.worst.planned << " for " << c.worst.reference << ", predicted " << c.predicted;
  EXPECT_GT(compared, 0);
}

TEST(Promise, PredictedIsWorthItsName) {
  for (const PromiseFigures& f : promiseFigures(theRun().cells)) {
    // 98 of 100 cells; of a few, one may be above.
    EXPECT_GE(f.foreseen * f.cells, std::min(0.98 * f.cells, f.cells - 1.0)) << "asked " << f.asked;
    EXPECT_LE(f.margin, 5.0) << "asked " << f.asked;
  }
}

// What shares its shading against all of its subpixels: a glint or a shadow that no pixel's middle shows may be missed, in one pixel of a hundred.
TEST(Promise, SharedSubpixelsAreWithinWhatIsAskedNearlyAllOver) {
  const int scenes = static_cast<int>(number("PITVIPER_PROMISE_AUTO", 4));
  const auto first = static_cast<std::uint64_t>(number("PITVIPER_PROMISE_SEED", static_cast<long long>(kSeed)));
  double beyond = 0.0;
  int cells = 0;
  for (int k = 0; k < scenes; ++k) {
    const PromiseScene s = sceneOf(first + static_cast<std::uint64_t>(k), {0.01}, true);
    for (const PromiseCell& c : s.cells) {
      beyond += c.beyond;
      ++cells;
      if (c.beyond > 0.0)
        std::fprintf(stderr, "seed %llu, %s: %.2g %% of pixels beyond (at most %.2g %%), worst %d, %d in frame %d: %g for %g\n",
                     static_cast<unsigned long long>(s.seed), c.channel.c_str(), 100.0 * c.beyond, 100.0 * c.found, c.worst.column, c.worst.row, c.worst.frame,
                     c.worst.planned, c.worst.reference);
    }
  }
  bound("random scenes with samples: auto at 1 %: pixels farther from all of their subpixels", beyond / std::max(cells, 1), 0.01, "geometry is asked of 99 %");
}

TEST(Promise, NoRadianceBelowZero) {
  for (const PromiseScene& s : theRun().scenes) EXPECT_EQ(s.negative, 0) << "seed " << s.seed;
}

TEST(RandomScenario, IsTheSameForTheSameSeedAndHasAllKinds) {
  std::string all;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const std::string text = randomScenario({seed, 0, 300, true});
    EXPECT_EQ(text, randomScenario({seed, 0, 300, true}));
    EXPECT_NE(text, randomScenario({seed, 1, 300, true}));
    all += text;
  }
  for (const char* word : {"clear_us76",
                           "hazy_mls",
                           "extinction",
                           "visibility",
                           "from: sky",
                           "solar_e490",
                           "sapphire_dome",
                           "oil_smoke",
                           "afterburner_plume",
                           "w3",
                           "w0b",
                           "lamp1",
                           "level",
                           "motion",
                           "frames: 3",
                           "samples: 2",
                           "small_bodies: 0",
                           "ground",
                           "transmission",
                           "modifier",
                           "c2",
                           "elevation: -0.",
                           "shadows: false",
                           "mode: buffered",
                           "rows",
                           "temperatures",
                           "gradient",
                           "ward",
                           "sandford_robertson",
                           "beard_maxwell",
                           "spectral_phong",
                           "sea, wind",
                           "plumes",
                           "nozzles",
                           "on: b0",
                           "turboshaft",
                           "reduced_smoke_motor",
                           "alumina: ",
                           "smokes",
                           "fog_oil",
                           "flares",
                           "pyrophoric",
                           "sequence",
                           "clouds:\n  - {name: heap"})
    EXPECT_NE(all.find(word), std::string::npos) << word;
}

}  // namespace
}  // namespace pitviper::test
