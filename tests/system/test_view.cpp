// pitviper view as a script drives it under a virtual display: pictures, probe, curves, dial, a scenario that breaks and is mended, frames, displays.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "scenarios/view/script.hpp"
#include "sim/frame/read_frame.hpp"
#include "sim/parameters/error.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

constexpr const char* kScene =
    "name: seen\naccuracy: 1 %\nbackground: {temperature: 250 K}\nsun: {azimuth: 60 deg, elevation: 40 deg, temperature: 5772 K}\n"
    "# what stays\nentities:\n  - {name: ball, shape: {model: sphere, radius: 1 m}, material: grey_aircraft_paint, temperature: 320 K}  # a ball\n"
    "cameras:\n  - name: eye\n    film: {width: 64, height: 48}\n    field_of_view: 16 deg\n    aperture: 5 mm\n    position: [10 m, 0 m, 0 m]\n    look_at: "
    "ball\n"
    "    channels:\n      - {name: mw, response: {band: [3.6 um, 4.9 um]}}\n      - {name: vis, response: {band: [0.45 um, 0.75 um]}}\n";

/// A display of its own, or why there is none.
bool hasDisplay() { return run("command -v xvfb-run").code == 0 && run("command -v xauth").code == 0; }

/// Runs a script, from a folder; what `print` printed by name.
std::map<std::string, std::string> seen(const TemporaryFolder& folder, const std::string& words, const std::string& script, int code = 0) {
  const std::string file = folder.put("script.txt", script);
  const Result r = run("cd " + folder.path().string() + " && PITVIPER_HOME=" + PITVIPER_SOURCE_DIR +
                       " xvfb-run -a -s '-screen 0 1280x800x24' sh -c '\"$@\"; echo \"ended with: $?\"' sh " + PITVIPER_PROGRAM + " view " + words +
                       " --width 1200 --height 760 --script " + file);
  std::map<std::string, std::string> said;
  std::istringstream lines(r.output);
  for (std::string line; std::getline(lines, line);)
    if (const auto at = line.find(": "); at != line.npos) said[line.substr(0, at)] = line.substr(at + 2);
  said["*"] = r.output;
  // The program's own: xvfb-run has codes too, as of its folder that it could not remove.
  EXPECT_EQ(said["ended with"], std::to_string(code)) << r.output;
  return said;
}

double number(const std::map<std::string, std::string>& said, const std::string& name) {
  const auto found = said.find(name);
  return found == said.end() ? NAN : std::stod(found->second);
}

std::string textOf(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::stringstream all;
  all << in.rdbuf();
  return all.str();
}

TEST(View, ScriptsAreReadOrRefused) {
  const auto script = parseScript("# what it does\nwait done 5\nclick \"layer:mw.radiance\"\ndrag plot 0.5 0.2 0.6 0.9\n", "s");
  ASSERT_EQ(script.size(), 3u);
  EXPECT_EQ(script[1].words[0], "layer:mw.radiance");
  EXPECT_EQ(script[2].where.line, 4);
  for (const char* wrong : {"clack play\n", "wait\n", "drag plot 1 2\n", "click \"no end\n", "resize 3\n"})
    EXPECT_THROW(parseScript(wrong, "s"), UserError) << wrong;
}

TEST(View, SaysWhereThereIsNoDisplay) {
  const TemporaryFolder folder;
  const Result r = run("env -u DISPLAY -u WAYLAND_DISPLAY PITVIPER_HOME=" + std::string(PITVIPER_SOURCE_DIR) + " " + PITVIPER_PROGRAM + " view " +
                       folder.put("a.yaml", kScene));
  EXPECT_EQ(r.code, 2) << r.output;
  EXPECT_NE(r.output.find("--script"), std::string::npos) << r.output;
  EXPECT_NE(r.output.find("xvfb-run"), std::string::npos) << r.output;
}

// A probe tells what a frame's file has: the same plan, the same picture.
TEST(View, ProbeTellsWhatRunWrites) {
  if (!hasDisplay()) GTEST_SKIP() << "no xvfb-run with xauth (packages xvfb, xauth)";
  const TemporaryFolder folder;
  const std::string scene = folder.put("a.yaml", kScene);
  const auto said = seen(folder, scene, "wait done\nclick mw.radiance 32 20\nwait probe\nprint *\nscreenshot shot.png\npicture layers.png\n");
  ASSERT_EQ(pitviper("run " + scene + " --out " + (folder.path() / "out").string()).code, 0);
  const Frame frame = readFrame(folder.path() / "out" / "eye_00000.exr");
  double worst = 0.0, ofReference = 0.0;
  for (const FrameLayer& l : frame.layers) {
    if (l.name.rfind("truth.", 0) == 0) continue;
    const double is = l.pixels[20 * 64 + 32], told = number(said, "probe." + l.name);
    worst = std::max(worst, std::abs(told / is - 1.0));
    // What the scenario asks for.
    ofReference = std::max(ofReference, std::abs(told / number(said, "reference." + l.name) - 1.0));
  }
  figure("view: a pixel told against the frame that run writes, relative", worst, 0.0, 1e-6, "the frame's file");
  EXPECT_LT(worst, 1e-6);  // nine digits are printed of a float
  EXPECT_LT(ofReference, 0.01);
  EXPECT_EQ(said.at("probe.body"), "ball");
  EXPECT_EQ(said.at("tier"), "as asked");
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "shot.png"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "layers.png"));
}

// A curve is drawn: the sphere, the scene and the file that is saved follow; nothing returns more than it receives; every step goes back.
TEST(View, CurvesAreDrawnAndSaved) {
  if (!hasDisplay()) GTEST_SKIP() << "no xvfb-run with xauth (packages xvfb, xauth)";
  const TemporaryFolder folder;
  const std::string scene = folder.put("a.yaml", kScene);
  const auto said =
      seen(folder, scene,
           "wait done\nclick mw.radiance 32 20\nwait 0.1\nprint probe.mw.radiance\nclick tab:material\nclick material_picked\nwait sphere\n"
           "click span\nclick \"span:3-5 um\"\ndrag plot 4.0 0.2 4.0 0.99\nwait done\nwait sphere\nprint point_value\nprint points\nclick tab:probe_panel\n"
           "wait 0.3\nprint probe.vis.radiance\nclick tab:material\nwait 0.1\nclick save_material\nkey ctrl+z\nwait done\nwait sphere\nprint message\nprint "
           "points\n");
  EXPECT_GT(number(said, "point_value"), 0.9) << said.at("*");
  EXPECT_LE(number(said, "point_value"), 1.0);
  const auto file = folder.path() / "grey_aircraft_paint_edited.yaml";
  ASSERT_TRUE(std::filesystem::exists(file)) << said.at("*");
  const Result loaded = pitviper("material " + file.string());
  EXPECT_EQ(loaded.code, 0) << loaded.output;
}

// What a person breaks in a scenario that is open, is said with its place; the last good scene stays, and what is mended comes back. What was changed by hand
// is written into it, with its comments.
TEST(View, SavedScenariosLoadThemselves) {
  if (!hasDisplay()) GTEST_SKIP() << "no xvfb-run with xauth (packages xvfb, xauth)";
  const TemporaryFolder folder;
  const std::string scene = folder.put("a.yaml", kScene);
  std::string broken = kScene;
  broken.replace(broken.find("field_of_view"), 13, "field_of_wiev");
  const std::string bad = folder.put("bad.txt", broken), good = folder.put("good.txt", kScene);
  // Files change when the script says so, by pictures that it writes, however slow the machine is.
  const auto after = [&](const char* picture) { return "while [ ! -e " + (folder.path() / picture).string() + " ]; do sleep 0.1; done; "; };
  const std::string changes = "(" + after("opened.png") + "cp " + bad + " " + scene + "; " + after("broken.png") + "cp " + good + " " + scene + ") & ";
  const std::string script = folder.put(
      "s.txt",
      "wait done\nprint problem\nscreenshot opened.png\nwait problem\nwait 0.3\nprint problem\nprint tier\nscreenshot broken.png\nwait good\nwait done\n"
      "print problem\nclick tab:scene\nwait 0.1\ndrag field_of_view 0.5 0.5 0.7 0.5\nwait 0.3\nprint changes\nkey ctrl+s\nwait 1\nwait done\nprint message\n");
  const Result r = run(changes + "cd " + folder.path().string() + " && PITVIPER_HOME=" + PITVIPER_SOURCE_DIR + " xvfb-run -a -s '-screen 0 1280x800x24' " +
                       PITVIPER_PROGRAM + " view " + scene + " --width 1200 --height 760 --script " + script);
  EXPECT_EQ(r.code, 0) << r.output;
  EXPECT_NE(r.output.find("a.yaml:11:"), std::string::npos) << r.output;
  EXPECT_NE(r.output.find("did you mean 'field_of_view'"), std::string::npos) << r.output;
  EXPECT_NE(r.output.find("--set cameras.eye.field_of_view="), std::string::npos) << r.output;
  const std::string written = textOf(scene);
  EXPECT_NE(written.find("# what stays"), std::string::npos);
  EXPECT_NE(written.find("# a ball"), std::string::npos);
  EXPECT_EQ(written.find("field_of_view: 16 deg"), std::string::npos) << written;
  EXPECT_EQ(pitviper("check " + scene).code, 0);
}

TEST(View, FramesAndWindowsOfAPixel) {
  if (!hasDisplay()) GTEST_SKIP() << "no xvfb-run with xauth (packages xvfb, xauth)";
  const TemporaryFolder folder;
  const std::string scene = folder.put("a.yaml", kScene), out = (folder.path() / "out").string();
  ASSERT_EQ(pitviper("run " + scene + " --out " + out + " --set time.frames=2").code, 0);
  const auto said =
      seen(folder, out,
           "wait done\nclick mw.radiance 32 20\nwait 0.1\nprint probe.mw.radiance\nkey right\nwait done\nprint file\nresize 1 1\nwait 0.5\nresize 1200 "
           "760\nwait 0.5\nscreenshot a.png\n");
  const Frame frame = readFrame(out + "/eye_00000.exr");
  for (const FrameLayer& l : frame.layers)
    if (l.name == "mw.radiance") {
      EXPECT_NEAR(number(said, "probe.mw.radiance"), static_cast<double>(l.pixels[20 * 64 + 32]), 1e-7) << said.at("*");
    }
  EXPECT_EQ(said.at("file"), "eye_00001.exr");
  seen(folder, "nothing.yaml", "wait done\nexpect problem nothing.yaml\n");
  seen(folder, scene, "click nothing\n", 2);
}

TEST(View, DisplaysMayGo) {
  if (!hasDisplay()) GTEST_SKIP() << "no xvfb-run with xauth (packages xvfb, xauth)";
  const TemporaryFolder folder;
  const std::string script = folder.put("s.txt", "wait done\nscreenshot drawn.png\nwait 100\n"), drawn = (folder.path() / "drawn.png").string();
  // The server says by its number that it listens.
  const Result r = run("cd " + folder.path().string() +
                       " && { Xvfb -displayfd 1 -screen 0 800x600x24 > number & server=$!; while [ ! -s number ]; do sleep 0.1; done; (while [ ! -e " + drawn +
                       " ]; do sleep 0.1; done; kill $server) & DISPLAY=:$(cat number) PITVIPER_HOME=" + PITVIPER_SOURCE_DIR + " " + PITVIPER_PROGRAM +
                       " view " + folder.put("a.yaml", kScene) + " --script " + script + "; }");
  EXPECT_TRUE(std::filesystem::exists(drawn)) << r.output;
  EXPECT_EQ(r.code, 1) << r.output;
}

}  // namespace
}  // namespace pitviper::test
