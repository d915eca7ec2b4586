// A second run of the same scenario compiles no program, draws the same bytes, and does so whatever is wrong with the cache.
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "tests/support/figures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

struct SecondRun : testing::Test {
  std::string run(const std::string& scenario, const std::string& out, const std::string& cache, const std::string& with = "",
                  const std::string& frames = "0:0") const {
    const std::string line = "cd " + folder.path().string() + " && " + with + " XDG_CACHE_HOME=" + cache + " PITVIPER_HOME=" + PITVIPER_SOURCE_DIR + " " +
                             PITVIPER_PROGRAM + " run " + scenario + " --frames " + frames + " --overwrite --out " + out + " 2>&1";
    FILE* pipe = popen(line.c_str(), "r");
    std::array<char, 4096> buffer{};
    std::string output;
    while (size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) output.append(buffer.data(), n);
    const int status = pclose(pipe);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << output;
    return output;
  }
  std::string frame(const std::string& out) const {
    std::ifstream in(folder.path() / out / "c_00000.exr", std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t entries(const std::string& cache) const {
    const fs::path programs = folder.path() / cache / "mesa_shader_cache";
    std::size_t count = 0;
    if (fs::exists(programs))
      for (const auto& f : fs::recursive_directory_iterator(programs)) count += f.is_regular_file();
    return count;
  }
  const TemporaryFolder folder;
};

const std::string kWorld =
    "accuracy: 3 %\natmosphere: clear_us76\nsun: {azimuth: 160 deg, elevation: 40 deg, temperature: 5772 K}\n"
    "materials: {m: {components: [{reflection: microfacet, index: aluminium, roughness: 0.2}]}, g: {components: [{reflection: lambertian, reflectance: "
    "0.3}]}}\n"
    "ground: {material: g, temperature: 290 K}\n";
const std::string kChannels = "channels: [{name: a, response: {band: [3.5 um, 4 um]}}]}]\n";
std::string ball(const std::string& name, const std::string& place) {
  return "{name: " + name + ", shape: {model: sphere, radius: 1 m, segments: 48}, material: m, temperature: 320 K, position: " + place + "}";
}

/// A ball that fills pixels and one of a few subpixels (pictures of several kinds), a film of a power of two and not; light from a sky; a jet before
/// what is small.
const std::array kScenes = {
    std::pair{
        "near",
        kWorld + "entities: [" + ball("b", "[0 m, 30 m, 20 m]") + "]\n" +
            "cameras: [{name: c, film: {width: 32, height: 32}, samples: 2, field_of_view: 5 deg, aperture: 20 mm, position: [0 m, 0 m, 20 m], look_at: b, " +
            kChannels},
    std::pair{"small",
              kWorld + "entities: [" + ball("b", "[0 m, 30 m, 20 m]") + ", " + ball("far", "[40 m, 3 km, 60 m]") + "]\n" +
                  "cameras: [{name: c, film: {width: 48, height: 40}, samples: auto, field_of_view: 5 deg, aperture: 20 mm, position: [0 m, 0 m, 20 m], "
                  "look_at: far, " +
                  kChannels},
    std::pair{"shadow",
              kWorld + "entities: [" + ball("b", "[0 m, 30 m, 20 m]") + ", " + ball("d", "[0.2 m, 27 m, 23 m]") + "]\n" +
                  "cameras: [{name: c, film: {width: 40, height: 64}, field_of_view: 9 deg, aperture: 20 mm, position: [0 m, 0 m, 20 m], look_at: b, " +
                  kChannels},
    std::pair{"jet", kWorld + "entities: [" + ball("far", "[1 m, 2 km, 61 m]") + "]\n" +
                         "plumes: [{name: p, nozzles: [[-12 m, 1990 m, 61 m]], direction: [1, 0, 0], engine: turboshaft, length: 30 m}]\n" +
                         "cameras: [{name: c, film: {width: 48, height: 40}, samples: auto, field_of_view: 1 deg, aperture: 20 mm, position: [0 m, 0 m, 20 m], "
                         "look_at: far, " +
                         kChannels}};

TEST_F(SecondRun, CompilesNothingAndIsTheSame) {
  for (const auto& [name, text] : kScenes) {
    const std::string scenario = std::string(name) + ".yaml", cache = std::string("cache_") + name;
    folder.put(scenario, text);
    run(scenario, "first", "$PWD/" + cache);
    const std::size_t before = entries(cache);
    ASSERT_GT(before, 0u);
    run(scenario, "second", "$PWD/" + cache);
    bound(std::string("programs that a second run of the same scenario compiles, ") + name, static_cast<double>(entries(cache) - before), 0.0,
          "none: all are in the driver's cache under the keys that it asks for");
    EXPECT_FALSE(frame("first").empty());
    EXPECT_EQ(frame("second"), frame("first"));
    // Drivers without a GPU clear memory that they give out, GPUs don't.
    run(scenario, "poisoned", "$PWD/" + cache, "PITVIPER_POISON=1");
    EXPECT_EQ(frame("poisoned"), frame("first")) << "nothing is read that was not written";
  }
}

std::string flying(const std::string& what, const std::string& from, const std::string& to) {
  return "{" + what + ", motion: [{time: 0 s, position: " + from + "}, {time: 5 s, position: " + to + "}]}";
}

/// At first a ball alone; then another flies in with its shadow, one that stays small, gas, and there is a jet.
const std::string kComesLater =
    kWorld + "time: {frames: 6, rate: 1 Hz}\nentities: [" + ball("b", "[-2 m, 30 m, 20 m]") + ", " +
    flying("name: near, shape: {model: sphere, radius: 1 m, segments: 48}, material: m, temperature: 320 K", "[-30 m, 27 m, 21 m]", "[20 m, 27 m, 21 m]") +
    ", " +
    flying("name: small, shape: {model: sphere, radius: 0.1 m}, material: m, temperature: 350 K", "[-60 m, 200 m, 24 m]", "[40 m, 200 m, 24 m]") + ", " +
    flying("name: gas, shape: {model: sphere, radius: 0.5 m}, material: afterburner_plume, temperature: 900 K", "[-20 m, 25 m, 20 m]", "[15 m, 25 m, 20 m]") +
    "]\nplumes: [{name: p, nozzles: [[0 m, 60 m, 20 m]], direction: [0, -1, 0], engine: turboshaft, length: 10 m, begin: 2.5 s}]\n" +
    "cameras: [{name: c, film: {width: 48, height: 40}, samples: auto, field_of_view: 12 deg, aperture: 20 mm, position: [0 m, 0 m, 20 m], "
    "look_at: [0 m, 30 m, 20 m], " +
    kChannels;

TEST_F(SecondRun, LaterFramesCompileNothing) {
  folder.put("later.yaml", kComesLater);
  run("later.yaml", "first", "$PWD/one", "", "0:1");
  run("later.yaml", "all", "$PWD/all", "", "0:5");
  ASSERT_GT(entries("one"), 0u);
  bound("programs that frames after the first compile, of things that come into view", static_cast<double>(entries("all") - entries("one")), 0.0,
        "none: the first picture has had all of them compiled");
}

/// Threads compile programs in the state that they will be drawn in: in another one the picture would have them compiled again.
TEST_F(SecondRun, ThreadsCompileWhatOneDoes) {
  cpu_set_t all;
  if (std::thread::hardware_concurrency() < 2 || sched_getaffinity(0, sizeof all, &all) != 0) GTEST_SKIP() << "one core";
  int one = 0;
  while (!CPU_ISSET(one, &all)) ++one;
  folder.put("later.yaml", kComesLater);
  run("later.yaml", "one", "$PWD/one", "taskset -c " + std::to_string(one) + " env");
  run("later.yaml", "all", "$PWD/all");
  ASSERT_GT(entries("one"), 0u);
  figure("programs that a run compiles on all cores", static_cast<double>(entries("all")), static_cast<double>(entries("one")), 0.0, "the same on one");
  EXPECT_EQ(frame("all"), frame("one"));
}

TEST_F(SecondRun, IsTheSameWhateverIsWrongWithTheCache) {
  const auto& [name, text] = kScenes[1];
  folder.put("s.yaml", text);
  EXPECT_EQ(run("s.yaml", "first", "$PWD/cache").find("note: the cache"), std::string::npos);
  std::size_t damaged = 0;
  for (const auto& f : fs::directory_iterator(folder.path() / "cache/pitviper"))
    if (f.path().filename().string().starts_with("table-")) fs::resize_file(f.path(), 30), ++damaged;
  EXPECT_GT(damaged, 0u);
  const std::string told = run("s.yaml", "damaged", "$PWD/cache");
  EXPECT_NE(told.find("is damaged and was removed"), std::string::npos) << told;
  EXPECT_EQ(told.find("note: the cache", told.find("note: the cache") + 1), std::string::npos) << "said once: " << told;
  EXPECT_EQ(frame("damaged"), frame("first"));
  EXPECT_EQ(run("s.yaml", "mended", "$PWD/cache").find("note: the cache"), std::string::npos);
  EXPECT_EQ(frame("mended"), frame("first"));
  folder.put("file", "in the way");
  const std::string without = run("s.yaml", "without", "$PWD/file");
  EXPECT_NE(without.find("file/pitviper is of no use: "), std::string::npos) << without;
  EXPECT_EQ(frame("without"), frame("first"));
}

}  // namespace
}  // namespace pitviper::test
