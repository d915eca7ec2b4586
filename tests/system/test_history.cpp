// What a run leaves of what was flown: tables and a picture, as a user finds them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "sim/image/png.hpp"
#include "tests/support/read_png.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

/// Two bodies that pass each other 5 m apart at 0.45 s, between two frames, one that stands, and a camera on the ground.
std::string scenario(const std::string& name = "pass") {
  return "name: " + name +
         "\ntime: {rate: 10 Hz, frames: 10}\nbackground: {temperature: 290 K}\nmaterials: {m: {components: []}}\nentities:\n"
         "- {name: east, shape: {model: sphere, radius: 1 m}, material: m, temperature: 305 K, motion: [{time: 0 s, position: [455 m, 100 m, 20 m]}, {time: 1 "
         "s, position: [555 m, "
         "100 m, 20 m]}]}\n"
         "- {name: west, shape: {model: sphere, radius: 1 m}, material: m, temperature: 310 K, motion: [{time: 0 s, position: [545 m, 100 m, 25 m]}, {time: 1 "
         "s, position: "
         "[445 m, 100 m, 25 m]}]}\n"
         "- {name: stands, shape: {model: sphere, radius: 1 m}, material: m, temperature: 300 K, position: [500 m, 120 m, 0 m]}\n"
         "cameras:\n- {name: eye, film: {width: 24, height: 16, pitch: 15 um}, field_of_view: 4 deg, f_number: 2, exposure: 2 ms, position: [500 m, -200 m, 2 "
         "m], look_at: east, "
         "channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}, output: [radiance]}]}\n";
}

std::string textOf(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::vector<std::string> linesOf(const fs::path& file) {
  std::istringstream text(textOf(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells(1);
  for (char c : line)
    if (c == ',') cells.emplace_back();
    else cells.back() += c;
  return cells;
}

class HistoryFiles : public ::testing::Test {
 protected:
  std::string out(const char* name = "out") const { return (folder_.path() / name).string(); }
  Result runs(const std::string& more, const char* name = "out") { return pitviper("run " + file_ + " --out " + out(name) + " " + more); }
  TemporaryFolder folder_;
  std::string file_ = folder_.put("pass.yaml", scenario());
  static bool hasCharts() { return fs::exists(fs::path(PITVIPER_BUILD_DIR) / "libpitviper_charts.so"); }
};

// Expectation: a row a frame for each of two bodies and the camera, every one with as many cells as the head; velocities are those of the waypoints; no other
// files.
TEST_F(HistoryFiles, HaveARowATickAndThing) {
  const Result r = runs("--frames 2:5");
  ASSERT_EQ(r.code, 0) << r.output;
  const std::vector<std::string> lines = linesOf(out() + "/history.csv");
  ASSERT_EQ(lines.size(), 2u + 4u * 3u);
  EXPECT_TRUE(lines[0].starts_with("# pitviper ")) << lines[0];
  const std::vector<std::string> head = cellsOf(lines[1]);
  const auto column = [&](const std::string& name) { return static_cast<std::size_t>(std::find(head.begin(), head.end(), name) - head.begin()); };
  std::set<std::string> names;
  for (std::size_t i = 2; i < lines.size(); ++i) {
    const std::vector<std::string> cells = cellsOf(lines[i]);
    ASSERT_EQ(cells.size(), head.size()) << lines[i];
    names.insert(cells[column("name")]);
    const double frame = std::stod(cells[column("frame")]), time = std::stod(cells[column("time_s")]), east = std::stod(cells[column("east_m")]);
    EXPECT_NEAR(time, 0.1 * frame, 1e-9);
    if (cells[column("name")] == "east") {
      EXPECT_NEAR(east, 455.0 + 100.0 * time, 1e-8);
      EXPECT_NEAR(std::stod(cells[column("velocity_east_m_s")]), 100.0, 1e-8);
      EXPECT_NEAR(std::stod(cells[column("heading_deg")]), 90.0, 1e-8);
    }
    if (cells[column("kind")] == "camera") {
      EXPECT_NEAR(std::stod(cells[column("heading_deg")]), std::atan2(455.0 + 100.0 * time - 500.0, 300.0) * 180.0 / M_PI + (time < 0.45 ? 360.0 : 0.0), 1e-6);
      // It turns at v d / r^2 over ground, and a little differs about its own axes, as it looks up by 3 deg.
      EXPECT_NEAR(std::stod(cells[column("yaw_rate_deg_s")]), 180.0 / M_PI * 100.0 * 300.0 / (300.0 * 300.0 + std::pow(100.0 * time - 45.0, 2)), 0.1);
    }
  }
  EXPECT_EQ(names, (std::set<std::string>{"east", "west", "eye"}));
  // The camera's nearest to what it looks at: 300 m over ground, 18 m up, between two frames.
  const std::vector<std::string> passes = linesOf(out() + "/encounters.csv");
  ASSERT_EQ(passes.size(), 3u);
  const std::vector<std::string> pass = cellsOf(passes[2]);
  EXPECT_EQ(pass[0] + ">" + pass[1], "eye>east");
  EXPECT_NEAR(std::stod(pass[3]), 0.45, 1e-6);
  EXPECT_NEAR(std::stod(pass[4]), std::hypot(300.0, 18.0), 1e-6);
  for (const auto& file : fs::directory_iterator(out())) {
    EXPECT_NE(file.path().filename().string()[0], '.') << file.path();
  }
}

// Expectation: frames again leave what says more; another scenario's history is not written over; none where it is not wanted.
TEST_F(HistoryFiles, StayWhereTheySayMore) {
  ASSERT_EQ(runs("").code, 0);
  const std::string whole = textOf(out() + "/history.csv");
  ASSERT_EQ(runs("--frames 4:5").code, 0);
  EXPECT_EQ(textOf(out() + "/history.csv"), whole);
  const std::string other = folder_.put("other.yaml", scenario("other"));
  fs::create_directories(out("second"));
  fs::copy_file(out() + "/history.csv", out("second") + "/history.csv");
  const Result refused = pitviper("run " + other + " --out " + out("second"));
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.output.find("history.csv"), std::string::npos) << refused.output;
  EXPECT_EQ(textOf(out("second") + "/history.csv"), whole);
  ASSERT_EQ(runs("--no-history --frames 0", "none").code, 0);
  EXPECT_FALSE(fs::exists(out("none") + "/history.csv"));
  EXPECT_FALSE(fs::exists(out("none") + "/encounters.csv"));
}

TEST_F(HistoryFiles, AreInTheReportWithAPicture) {
  if (!hasCharts()) GTEST_SKIP() << "built without VTK";
  const Result r = runs("--report --frames 0:4");
  ASSERT_EQ(r.code, 0) << r.output;
  const std::string page = textOf(out() + "/report.html");
  EXPECT_NE(page.find("What was flown"), std::string::npos);
  EXPECT_NE(page.find("href=\"history.csv\""), std::string::npos);
  EXPECT_NE(page.find("href=\"encounters.csv\""), std::string::npos);
  EXPECT_NE(page.find("camera eye"), std::string::npos);
  const Rgb8Image picture = readPng(out() + "/trajectories.png");
  // Both bodies' colours, in lines that are long on it: 2 px wide and some hundred long.
  for (const Rgb8 colour : {Rgb8{0, 114, 178}, Rgb8{213, 94, 0}}) {
    int count = 0;
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3)
      count += std::abs(picture.rgb[i] - colour.r) + std::abs(picture.rgb[i + 1] - colour.g) + std::abs(picture.rgb[i + 2] - colour.b) < 60;
    EXPECT_GT(count, 400);
  }
  EXPECT_EQ(readPngText(out() + "/trajectories.png", "pitviper.scenario"), "pass");
  // Alone, too.
  ASSERT_EQ(runs("--trajectories --no-history --frames 0:4", "alone").code, 0);
  EXPECT_TRUE(fs::exists(out("alone") + "/trajectories.png"));
  EXPECT_FALSE(fs::exists(out("alone") + "/history.csv"));
}

// The module is looked for beside the program: a copy of the program elsewhere is one without VTK.
TEST_F(HistoryFiles, ComeWithoutVtk) {
  const fs::path program = folder_.path() / "pitviper";
  fs::copy_file(PITVIPER_PROGRAM, program);
  const std::string call = std::string("PITVIPER_HOME=") + PITVIPER_SOURCE_DIR + " " + program.string() + " run " + file_ + " --out " + out();
  const Result r = run(call + " --report --frames 0:2");
  ASSERT_EQ(r.code, 0) << r.output;
  EXPECT_TRUE(fs::exists(out() + "/history.csv"));
  EXPECT_FALSE(fs::exists(out() + "/trajectories.png"));
  const std::string page = textOf(out() + "/report.html");
  EXPECT_NE(page.find("No picture of the trajectories"), std::string::npos);
  EXPECT_NE(page.find("libvtk9"), std::string::npos);
  const Result refused = run(call + " --trajectories --frames 0:2");
  EXPECT_EQ(refused.code, 2) << refused.output;
  EXPECT_NE(refused.output.find("libvtk9"), std::string::npos) << refused.output;
}

TEST_F(HistoryFiles, OfStillScenesAreNone) {
  const std::string still = folder_.put(
      "still.yaml",
      "name: still\ntime: {rate: 10 Hz, frames: 2}\nbackground: {temperature: 290 K}\nmaterials: {m: {components: []}}\nentities:\n- {name: ball, shape: "
      "{model: sphere, radius: 1 m}, material: m, temperature: 305 K, position: [100 m, 0 m, 0 m]}\ncameras:\n- {name: eye, film: {width: 8, height: 8, "
      "pitch: 15 um}, field_of_view: 4 deg, f_number: 2, exposure: 2 ms, look_at: ball, channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}, output: "
      "[radiance]}]}\n");
  ASSERT_EQ(pitviper("run " + still + " --out " + out()).code, 0);
  EXPECT_FALSE(fs::exists(out() + "/history.csv"));
  const Result refused = pitviper("run " + still + " --trajectories --out " + out());
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.output.find("nothing moves"), std::string::npos) << refused.output;
}

// Expectation: a stream's history is that of a run, row by row.
TEST_F(HistoryFiles, OfAStreamAreThoseOfARun) {
  ASSERT_EQ(runs("").code, 0);
  const Result r = pitviper("stream " + file_ + " --clock free --shared-memory /pitviper.test." + std::to_string(getpid()) + ".history --out " + out("stream") +
                            " --history");
  ASSERT_EQ(r.code, 0) << r.output;
  EXPECT_EQ(textOf(out("stream") + "/history.csv"), textOf(out() + "/history.csv"));
  EXPECT_EQ(textOf(out("stream") + "/encounters.csv"), textOf(out() + "/encounters.csv"));
}

}  // namespace
}  // namespace pitviper::test
