// `plan` as a user runs it, a scenario that extends another, and `bench --scenario`.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace {

namespace fs = std::filesystem;

class PlanCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("pitviper_plan_command_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    put("base.yaml",
        "atmosphere: clear_us76\nsun: {azimuth: 180 deg, elevation: 40 deg, temperature: 5772 K}\n"
        "materials: {m: {components: [{reflection: lambertian, reflectance: 0.3}]}}\n"
        "entities: [{name: wall, shape: {model: plate, width: 90 m, height: 90 m}, material: m, temperature: 305 K, position: [0 m, 2 km, 60 m], heading: 180 "
        "deg}]\n"
        "cameras: [{name: c, film: {width: 16, height: 16}, field_of_view: 1 deg, aperture: 5 mm, position: [0 m, 0 m, 50 m], look_at: wall, channels: "
        "[{name: mw, response: {band: [3.4 um, 5 um]}}, {name: lw, response: {band: [8 um, 12 um]}}]}]\n");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void put(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  std::pair<int, std::string> run(const std::string& arguments) const {
    const std::string line = "cd " + folder_.string() + " && XDG_CACHE_HOME=" + (folder_ / "cache").string() + " PITVIPER_HOME=" + PITVIPER_SOURCE_DIR + " " +
                             PITVIPER_PROGRAM + " " + arguments + " 2>&1";
    FILE* pipe = popen(line.c_str(), "r");
    std::array<char, 4096> buffer{};
    std::string output;
    while (size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) output.append(buffer.data(), n);
    const int status = pclose(pipe);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, output};
  }
  fs::path folder_;
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_F(PlanCommand, TellsWhatItChose) {
  const auto [code, text] = run("plan base.yaml");
  EXPECT_EQ(code, 0) << text;
  for (const char* part : {"camera c: within 1.00 %", "emission of surfaces", "reflected sunlight", "emission of the air", "predicted error",
                           "K of a body at 300 K", "planned in"})
    EXPECT_TRUE(has(text, part)) << part << "\n" << text;
  EXPECT_FALSE(has(text, "MORE THAN ASKED FOR"));
  const auto [jsonCode, json] = run("plan base.yaml --json");
  EXPECT_EQ(jsonCode, 0);
  for (const char* part : {"[{\"name\": \"camera c\"", "\"accuracy\": 0.01", "\"channels\": [{\"name\": \"mw\", \"nodes\": ", "\"predicted_error\": "})
    EXPECT_TRUE(has(json, part)) << part << "\n" << json;
  EXPECT_TRUE(has(run("plan base.yaml --shaders").second, "void integrate()"));
  const auto [plainCode, plain] = run("plan base.yaml --set accuracy=reference");
  EXPECT_EQ(plainCode, 0);
  EXPECT_TRUE(has(plain, "none predicted")) << plain;
}

TEST_F(PlanCommand, AScenarioExtendsAnother) {
  put("other.yaml",
      "extends: base.yaml\naccuracy: 5 %\ncameras: [{name: d, film: {width: 8, height: 8}, field_of_view: 1 deg, aperture: 5 mm, position: [0 m, 0 m, 50 m], "
      "look_at: wall, channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n");
  const auto [code, text] = run("plan other.yaml");
  EXPECT_EQ(code, 0) << text;
  EXPECT_TRUE(has(text, "camera d: within 5.00 %")) << text;
  EXPECT_EQ(run("run other.yaml --out out").first, 0);
  EXPECT_TRUE(fs::exists(folder_ / "out/d_00000.exr"));
  put("further.yaml", "extends: other.yaml\n");
  EXPECT_EQ(run("check further.yaml").first, 0);
  put("nowhere.yaml", "extends: nothing.yaml\n");
  EXPECT_TRUE(has(run("check nowhere.yaml").second, "nowhere.yaml:1:10: cannot read the file"));
  put("above.yaml", "extends: ../../base.yaml\n");
  EXPECT_TRUE(has(run("check above.yaml").second, "above.yaml:1:10: not the name of a scenario near this one"));
  EXPECT_TRUE(has(run("check other.yaml --set extends=further.yaml").second, "cannot be set from outside"));
}

TEST_F(PlanCommand, BenchTimesAScenario) {
  const auto [code, text] = run("bench --scenario base.yaml --frames 10");
  EXPECT_EQ(code, 0) << text;
  EXPECT_TRUE(has(text, "| c | 2 | ")) << text;
  EXPECT_EQ(run("bench --scenario base.yaml --factor layers").first, 2);
}

}  // namespace
