// What `check`, `run`, `plan`, `info` and `atmosphere` tell a user who pipes them into a file.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace {

namespace fs = std::filesystem;

const std::string kCamera =
    "cameras: [{name: eye, film: {width: 32, height: 32}, field_of_view: 2 deg, aperture: 5 mm, position: [0 m, 0 m, 50 m], look_at: [0 m, 1 km, 50 m], "
    "channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n";
const std::string kBodies =
    "time: {rate: 1 Hz, frames: 5}\n"
    "entities:\n"
    "  - {name: wall, shape: {model: plate, width: 10 m, height: 10 m}, material: blackbody, temperature: 300 K, position: [0 m, 1 km, 50 m], heading: 180 "
    "deg}\n"
    "  - {name: ball, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 320 K, motion: [{time: 0 s, position: [0 m, 500 m, 50 m]}, {time: "
    "2 s, "
    "position: [0 m, 2 km, 50 m]}, {time: 4 s, position: [0 m, 2 km, 950 m]}], interpolation: linear}\n"
    "  - {name: speck, shape: {model: sphere, radius: 1 cm}, material: blackbody, temperature: 320 K, position: [-12 m, 1 km, 60 m]}\n";

class CheckAndRun : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("pitviper_check_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void put(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
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

/// As `info` prints it.
std::string attribute(const std::string& name, const std::string& value) { return "\n" + name + std::string(44 - name.size(), ' ') + " " + value + "\n"; }

std::string lineOf(const std::string& text, const std::string& start) {
  size_t at = text.find("\n    " + start);
  if (at == std::string::npos) return "";
  return text.substr(at + 1, text.find('\n', at + 1) - at - 1);
}

TEST_F(CheckAndRun, TellsWhatEachCameraSees) {
  put("s.yaml", kBodies + kCamera);
  const auto [code, text] = run("check s.yaml");
  ASSERT_EQ(code, 0) << text;
  EXPECT_TRUE(has(text, "camera eye, in frame 0 | 2 | 4:")) << text;
  // 2 deg over 32 pixels: 1.091 mrad each; 10 m at 1 km are 9.17 of them, 2 m at 500 m 3.67.
  const std::string wall = lineOf(text, "wall"), ball = lineOf(text, "ball"), speck = lineOf(text, "speck");
  EXPECT_TRUE(has(wall, "0 x 10 x 10 m") && has(wall, "1 km, 9.2 x 9.2 px")) << wall;
  EXPECT_TRUE(has(ball, "500 m, 3.7 x 3.7 px") && has(ball, "| 2 km, hidden by wall") && has(ball, "out of view")) << ball;
  EXPECT_TRUE(has(speck, "20 x 20 x 20 mm") && has(speck, "0.018 x 0.018 px, smaller than a pixel")) << speck;
  EXPECT_FALSE(has(text, "note:")) << text;
}

TEST_F(CheckAndRun, ManyAlikeShareALine) {
  std::string bodies = "entities:\n";
  for (int k = 0; k < 60; ++k)
    bodies += "  - {name: tree_" + std::to_string(k) + ", shape: {model: sphere, radius: 2 m}, material: blackbody, temperature: 290 K, position: [" +
              std::to_string(k % 10 - 5) + " m, " + std::to_string(300 + 20 * k) + " m, 50 m]}\n";
  bodies += "  - {name: away, shape: {model: sphere, radius: 2 m}, material: blackbody, temperature: 290 K, position: [0 m, -900 m, 50 m]}\n";
  put("s.yaml", bodies + kCamera);
  const auto [code, text] = run("check s.yaml");
  ASSERT_EQ(code, 0) << text;
  EXPECT_TRUE(has(text, " more  4 x 4 x 4 m  ")) << text;
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 10) << text;
  EXPECT_TRUE(has(lineOf(text, "away"), "900 m, behind the camera")) << text;
}

TEST_F(CheckAndRun, NotesACameraThatSeesNothingAndDoubtfulUnits) {
  put("body.obj", "v 0 0 0\nv 15100 0 0\nv 0 10500 0\nv 0 0 4000\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  put("s.yaml",
      "entities: [{name: jet, shape: {model: mesh, file: body.obj, unit: 1 m}, material: blackbody, temperature: 300 K, position: [0 m, -99 km, 0 m]}]\n" +
          kCamera);
  const auto [code, text] = run("check s.yaml");
  ASSERT_EQ(code, 0) << text;
  EXPECT_TRUE(has(text, "note: camera eye sees no body in these frames")) << text;
  EXPECT_TRUE(has(text, "note: mesh of 'jet' (body.obj) is 15100 m long; it would be 15.1 m if the file is in millimetres")) << text;
}

TEST_F(CheckAndRun, ATextureNeedsTextureCoordinates) {
  put("body.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  auto scene = [&](const std::string& temperature, const std::string& material) {
    put("s.yaml", "entities:\n  - name: rock\n    shape: {model: mesh, file: body.obj, unit: 1 m}\n    material: " + material +
                      "\n    temperature: " + temperature + "\n    position: [0 m, 1 km, 50 m]\n" + kCamera);
    return run("check s.yaml");
  };
  const auto [code, text] = scene("{rows: [[280 K, 290 K], [300 K, 310 K]]}", "blackbody");
  EXPECT_EQ(code, 2);
  EXPECT_TRUE(has(text, "s.yaml:5:18: a texture on part 'all' of 'rock', which has no texture coordinates")) << text;
  const auto [modified, said] = scene("280 K", "{components: [{reflection: lambertian, reflectance: 0.5, modifier: {rows: [[0.2, 0.4]]}}]}");
  EXPECT_EQ(modified, 2);
  EXPECT_TRUE(has(said, "s.yaml:4:15: a texture on part 'all' of 'rock'")) << said;
  EXPECT_EQ(scene("{rows: [[280 K]]}", "blackbody").first, 0);  // one texel says the same everywhere
}

TEST_F(CheckAndRun, AxesOfAMesh) {
  put("body.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  auto scene = [&](const std::string& axes) {
    put("s.yaml", "entities: [{name: rock, shape: {model: mesh, file: body.obj, unit: 1 m, " + axes +
                      "}, material: blackbody, temperature: 280 K, position: [0 m, 1 km, 50 m]}]\n" + kCamera);
    return run("check s.yaml");
  };
  EXPECT_EQ(scene("forward: -z, up: +y").first, 0);
  const auto [code, text] = scene("up: +x");
  EXPECT_EQ(code, 2);
  EXPECT_TRUE(has(text, "point along the same axis") && has(text, "add 'forward:'")) << text;
  EXPECT_TRUE(has(scene("forward: +w").second, "+x, -x, +y"));
}

// Rationale: a heading given once is an attitude. Expected: whole turns are taken and change nothing; in a motion they are refused, since they would not
// be turned.
TEST_F(CheckAndRun, WholeTurnsOfAnAttitude) {
  auto frame = [&](const std::string& heading) {
    put("s.yaml",
        "entities: [{name: b, shape: {model: box, length: 20 m, width: 2 m, height: 5 m}, material: blackbody, temperature: 300 K, position: [0 m, 1 km, 50 "
        "m], heading: " +
            heading + "}]\n" + kCamera);
    const auto [code, text] = run("check s.yaml");
    EXPECT_EQ(code, 0) << text;
    return lineOf(text, "b ");
  };
  EXPECT_EQ(frame("750 deg"), frame("30 deg"));
  EXPECT_NE(frame("30 deg"), frame("80 deg"));
  put("t.yaml",
      "entities: [{name: b, shape: {model: sphere, radius: 2 m}, material: blackbody, temperature: 300 K, motion: [{time: 0 s, position: [0 m, 1 km, 50 m], "
      "heading: 720 deg}]}]\n" +
          kCamera);
  EXPECT_EQ(run("check t.yaml").first, 2);
}

TEST_F(CheckAndRun, TheTotalOfARun) {
  put("s.yaml", "accuracy: 1 %\n" + kBodies + kCamera);
  const auto [code, text] = run("run s.yaml --frames 1:3 --out out");
  ASSERT_EQ(code, 0) << text;
  EXPECT_TRUE(has(text, "3 frames of 1 camera in out (")) << text;  // both ends included
  EXPECT_TRUE(has(text, " frames a second")) << text;
  EXPECT_TRUE(has(text, "eye: planned to 1 %; expected error at most lw ")) << text;
  EXPECT_TRUE(has(run("info out/eye_00001.exr").second, attribute("pitviper.mode", "planned")));
  const auto [again, reference] = run("run s.yaml --frames 1 --out ref --set accuracy=reference --set cameras.0.film.width=4 --set cameras.0.film.height=4");
  EXPECT_EQ(again, 0) << reference;
  EXPECT_TRUE(has(reference, "eye: reference")) << reference;
  EXPECT_TRUE(has(run("info ref/eye_00001.exr").second, attribute("pitviper.mode", "reference")));
}

TEST_F(CheckAndRun, ExtendsAScenarioInAnotherFolder) {
  put("common/heat.csv", "wavelength [um], value [1]\n7, 0.5\n13, 0.5\n");
  put("common/base.yaml",
      "materials: {grey: {emission: {emissivity: {file: heat.csv}}}}\nentities: [{name: wall, shape: {model: plate, width: 10 m, height: 10 m}, material: "
      "grey, "
      "temperature: 300 K, position: [0 m, 1 km, 50 m], heading: 180 deg}]\n");
  put("mine/a.yaml", "extends: ../common/base.yaml\n" + kCamera);
  put("b.yaml", "extends: common/base.yaml\n" + kCamera);
  EXPECT_EQ(run("check mine/a.yaml").first, 0) << run("check mine/a.yaml").second;  // heat.csv lies beside the scenario that names it
  EXPECT_EQ(run("check b.yaml").first, 0);
  for (const std::string& bad :
       {"../../" + folder_.filename().string() + "/common/base.yaml", (folder_ / "common/base.yaml").string(), std::string("../common/heat.csv")}) {
    put("mine/c.yaml", "extends: " + bad + "\n" + kCamera);
    const auto [code, text] = run("check mine/c.yaml");
    EXPECT_EQ(code, 2);
    EXPECT_TRUE(has(text, "mine/c.yaml:1:10: not the name of a scenario near this one")) << text;
  }
  fs::create_directories(folder_ / "mine/links");
  fs::create_symlink("/etc", folder_ / "mine/links/etc");
  put("mine/d.yaml", "extends: links/etc/base.yaml\n" + kCamera);
  EXPECT_TRUE(has(run("check mine/d.yaml").second, "not the name of a scenario near this one"));
}

TEST_F(CheckAndRun, PlanNamesEachOutputOnce) {
  put("s.yaml",
      "accuracy: 1 %\n" + kBodies +
          "cameras: [{name: eye, film: {width: 8, height: 8}, field_of_view: 2 deg, aperture: 5 mm, position: [0 m, 0 m, 50 m], look_at: wall, channels: "
          "[{name: mw, response: {band: [3 um, 5 um]}, output: [radiance, irradiance, photon_radiance]}, {name: lw, response: {band: [8 um, 12 um]}}]}]\n");
  const auto [code, text] = run("plan s.yaml");
  ASSERT_EQ(code, 0) << text;
  EXPECT_TRUE(has(text, " mw.radiance+mw.irradiance mw.photon_radiance        lw\n")) << text;
  EXPECT_TRUE(has(text, "\n  mw.photon_radiance ")) << text;
  EXPECT_TRUE(has(run("plan s.yaml --json").second, "{\"name\": \"mw.photon_radiance\", \"nodes\""));
}

TEST_F(CheckAndRun, AirsOfTheLibraryByName) {
  const auto [code, list] = run("atmosphere");
  EXPECT_EQ(code, 0) << list;
  for (const char* name : {"clear_mls", "clear_us76", "hazy_mls", "hazy_us76", "Mid-latitude summer"}) EXPECT_TRUE(has(list, name)) << list;
  const auto [one, clear] = run("atmosphere clear_mls");
  EXPECT_EQ(one, 0) << clear;
  const auto [two, hazy] = run("atmosphere hazy_mls");
  EXPECT_EQ(two, 0) << hazy;
  EXPECT_NE(clear, hazy);
  EXPECT_TRUE(has(clear, "clear_mls: Mid-latitude summer") && has(clear, "no aerosol; its table:")) << clear;
  // Their figures differ by the haze; those of the table itself are the hazy ones, 23 km being its own visibility.
  EXPECT_NE(clear.substr(clear.find("mean transmittance")), hazy.substr(hazy.find("mean transmittance")));
  const std::string own = run("atmosphere us76_rural").second, named = run("atmosphere hazy_us76").second;
  EXPECT_TRUE(has(named, own)) << own << named;
  const auto [bad, said] = run("atmosphere clear_msl");
  EXPECT_EQ(bad, 2);
  EXPECT_TRUE(has(said, "did you mean 'clear_mls'?")) << said;
  EXPECT_EQ(run("atmosphere clear_mls --out air").first, 0);
  EXPECT_TRUE(fs::exists(folder_ / "air/clear_mls.csv"));
  EXPECT_EQ(run("atmosphere --range 5").first, 2);
}

TEST_F(CheckAndRun, AResponseCutIsNoted) {
  put("s.yaml",
      "atmosphere: hazy_us76\n" + kBodies +
          "cameras: [{name: eye, film: {width: 8, height: 8}, field_of_view: 2 deg, aperture: 5 mm, position: [0 m, 0 m, 50 m], look_at: wall, channels: "
          "[{name: lw, response: microbolometer_lwir, output: [radiance, irradiance]}]}]\n");
  const auto [code, text] = run("check s.yaml");
  ASSERT_EQ(code, 0) << text;
  const std::string note = "note: camera eye, channel 'lw': ";
  EXPECT_TRUE(has(text, note)) << text;
  EXPECT_EQ(text.find(note), text.rfind(note)) << text;
  const auto [ran, said] = run("run s.yaml --frames 0 --out out");
  EXPECT_EQ(ran, 0) << said;
  EXPECT_TRUE(has(said, note)) << said;
  EXPECT_TRUE(has(run("info out/eye_00000.exr").second, "pitviper.response_cut.lw.radiance")) << said;
}

// Rationale: what is mended in a mesh and where it lies is no secret. Expected: a line of check and of run for each file, and none for one that is as it should
// be.
TEST_F(CheckAndRun, MeshesTellWhatWasMended) {
  const std::string cube = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";
  const std::string right = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n",
                    turned = "f 2 4 3 1\nf 7 8 6 5\nf 5 6 2 1\nf 4 8 7 3\nf 3 7 5 1\nf 6 8 4 2\n";
  put("right.obj", cube + right);
  put("turned.obj", cube + turned);
  put("far.obj", "v 4649776.2 0 0\nv 4649776.2 1 0\nv 4649776.2 0 1\nf 1 2 3\n");
  const auto body = [](const std::string& name) {
    return "  - {name: " + name + ", shape: {model: mesh, file: " + name +
           ".obj, unit: 1 m}, material: blackbody, temperature: 300 K, position: [0 m, 1 km, 50 m]}\n";
  };
  put("s.yaml", "entities:\n" + body("right") + body("turned") + body("far") + kCamera);
  for (const char* command : {"check s.yaml", "run s.yaml --overwrite"}) {
    const auto [code, said] = run(command);
    EXPECT_EQ(code, 0) << said;
    EXPECT_TRUE(has(said, "note: mesh of 'turned' (turned.obj): 1 of 1 closed shell faced the wrong way, and was turned\n")) << said;
    EXPECT_TRUE(has(said, "note: mesh of 'far' (far.obj): it lies about (4649776.25, 0.5, 0.5) m forward, left and up of its file's origin")) << said;
    EXPECT_FALSE(has(said, "mesh of 'right'")) << said;
  }
  put("turned.obj", cube + turned + "f 1 8 2 7\n");
  const auto [code, said] = run("check s.yaml");
  EXPECT_EQ(code, 2);
  EXPECT_TRUE(has(said, "turned.obj:15:1: face 7 crosses itself; expected a face whose edges meet at corners only; fix: ")) << said;
}

}  // namespace
