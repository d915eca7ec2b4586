// Scenarios put together from files, parameters and repeated entries, as a user runs them.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string kAir = "sun: {azimuth: 180 deg, elevation: 40 deg, temperature: 5772 K}\n";
const std::string kCamera =
    "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 2 deg, aperture: 5 mm, position: [0 m, 0 m, 50 m], look_at: wall_0, channels: [{name: lw, "
    "response: {band: [8 um, 12 um]}}]}]\n";
/// In the folder of parts: what it names lies there.
const std::string kWall =
    "parameters: {hot: 300 K}\nname: wall\nshape: {model: plate, width: 10 m, height: 10 m}\nmaterial: {emission: {emissivity: {file: "
    "heat.csv}}}\ntemperature: "
    "$hot\nposition: [0 m, 1 km, 50 m]\nheading: 180 deg\n";

struct Parts : testing::Test {
  TemporaryFolder folder;
  Parts() {
    for (const char* name : {"own", "parts", "cache"}) fs::create_directories(folder.path() / name);
    folder.put("parts/air.yaml", kAir);
    folder.put("parts/wall.yaml", kWall);
    folder.put("parts/heat.csv", "wavelength [um], value [1]\n7, 0.5\n13, 0.5\n");
    folder.put("own/s.yaml",
               "include: ../parts/air.yaml\nparameters: {n: 2}\nentities:\n  - {include: ../parts/wall.yaml, with: {hot: 310 K}, repeat: {count: $n, every: "
               "{position: [0 m, 9 m, 0 m]}}}\n" +
                   kCamera);
  }
  Result go(const std::string& arguments) const {
    return run("cd " + folder.path().string() + " && XDG_CACHE_HOME=" + (folder.path() / "cache").string() + " PITVIPER_HOME=" + PITVIPER_SOURCE_DIR + " " +
               PITVIPER_PROGRAM + " " + arguments);
  }
};

// Expected: parts elsewhere are refused with the fix, which then works, in every command that reads a scenario.
TEST_F(Parts, RootsAllowFolders) {
  const Result refused = go("check own/s.yaml");
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(has(refused.output, "own/s.yaml:1:10: '../parts/air.yaml' is not a file that a scenario may include")) << refused.output;
  EXPECT_TRUE(has(refused.output, "allow its folder by --root FOLDER")) << refused.output;
  const Result checked = go("check own/s.yaml --root parts");
  EXPECT_EQ(checked.code, 0) << checked.output;
  EXPECT_TRUE(has(checked.output, "2 entities")) << checked.output;
  EXPECT_TRUE(has(go("check own/s.yaml --root own --root parts --set parameters.n=3").output, "3 entities"));
  const Result drawn = go("run own/s.yaml --root parts --out out");
  EXPECT_EQ(drawn.code, 0) << drawn.output;
  EXPECT_EQ(go("plan own/s.yaml --root parts").code, 0);
  EXPECT_EQ(go("plan own/s.yaml").code, 2);
  const Result terms = go("info out/c_00000.exr --at 4,4 --terms own/s.yaml --root parts");
  EXPECT_EQ(terms.code, 0) << terms.output;
  EXPECT_EQ(go("bench --scenario own/s.yaml --root parts --frames 10").code, 0);
  EXPECT_EQ(go("stream own/s.yaml --root parts --frames 2 --clock free --out streamed").code, 0);
  // Where what is included changes, it is another scenario: its files are not replaced.
  folder.put("parts/air.yaml", "sun: {azimuth: 180 deg, elevation: 50 deg, temperature: 5772 K}\n");
  EXPECT_EQ(go("info out/c_00000.exr --at 4,4 --terms own/s.yaml --root parts").code, 2);
}

TEST_F(Parts, MessagesPointIntoParts) {
  const auto told = [&](const std::string& options) {
    const Result r = go("check own/s.yaml --root parts " + options);
    EXPECT_EQ(r.code, 2) << r.output;
    return r.output;
  };
  EXPECT_TRUE(has(told("--root nowhere"), "--root nowhere: not a folder"));
  EXPECT_TRUE(has(told("--set parameters.m=1"), "there is no parameter 'm'; expected one of n")) << told("--set parameters.m=1");
  EXPECT_TRUE(has(told("--set include=x.yaml"), "cannot be set from outside"));
  EXPECT_TRUE(has(told("--set entities.wall_1.temperatur=3"), "did you mean 'temperature'?"));
  folder.put("parts/wall.yaml", kWall + "headin: 3 deg\n");
  EXPECT_TRUE(has(told(""), "wall.yaml:8:1: unknown key 'headin' in entity")) << told("");
  folder.put("parts/wall.yaml", kWall + "pitch: = $hot + 3 m\n");
  EXPECT_TRUE(has(told(""), "wall.yaml:8:8: '310 K' and '3 m' cannot be added")) << told("");
  folder.put("parts/wall.yaml", kWall + "pitch: $hot\n");
  EXPECT_TRUE(has(told(""), "own/s.yaml:4:47: pitch has the wrong unit 'K'")) << told("");
  EXPECT_EQ(go("run own/s.yaml --root").code, 2);
}

}  // namespace
}  // namespace pitviper::test
