// The program as a user runs it: commands, exit codes, files.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "sim/image/exr.hpp"

namespace {

namespace fs = std::filesystem;

struct Result {
  int code = -1;
  std::string output;
};

/// Runs a shell command line, both streams together.
Result run(const std::string& line) {
  Result r;
  FILE* pipe = popen((line + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer{};
  while (size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) r.output.append(buffer.data(), n);
  const int status = pclose(pipe);
  r.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  return r;
}

Result pitviper(const std::string& arguments) { return run(std::string("PITVIPER_HOME=") + PITVIPER_SOURCE_DIR + " " + PITVIPER_PROGRAM + " " + arguments); }

std::string bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream s;
  s << in.rdbuf();
  return s.str();
}

class Commands : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("pitviper_commands_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string scenario(const char* name) const { return std::string(PITVIPER_SOURCE_DIR) + "/scenarios/" + name; }
  fs::path folder_;
};

TEST_F(Commands, HelpOfEveryCommand) {
  const Result all = pitviper("--help");
  EXPECT_EQ(all.code, 0);
  for (const char* command : {"run", "check", "plan", "info", "integrate", "bench", "atmosphere", "keys"}) {
    EXPECT_NE(all.output.find(command), std::string::npos);
    const Result one = pitviper(std::string(command) + " --help");
    EXPECT_EQ(one.code, 0);
    EXPECT_NE(one.output.find("pitviper " + std::string(command)), std::string::npos);
  }
  EXPECT_EQ(pitviper("rnu x.yaml").code, 2);
}

// Rationale: frames feed hardware and regression comparisons. Expected: the same scenario, seed and driver give the same bytes.
TEST_F(Commands, TheSameBytesTwice) {
  // A plan made and one found again, as coarse as may be.
  const std::string line = "run " + scenario("first_light.yaml") +
                           " --frames 20:21 --set accuracy='10 %' --set 'cameras.0.channels=[{name: mw, response: {band: [3.6 um, 4.9 um]}}]' --set "
                           "cameras.0.samples=1 --set cameras.0.film.width=64 --set cameras.0.film.height=64 --out " +
                           folder_.string();
  ASSERT_EQ(pitviper(line + "/a").code, 0);
  ASSERT_EQ(pitviper(line + "/b").code, 0);
  int compared = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "a")) {
    EXPECT_EQ(bytes(entry.path()), bytes(folder_ / "b" / entry.path().filename())) << entry.path();
    ++compared;
  }
  EXPECT_EQ(compared, 5);  // two frames, the plan, where things were and how near they came
}

TEST_F(Commands, FramesCarryUnitsAndPose) {
  const Result r = pitviper("run " + scenario("first_light.yaml") +
                            " --frames 3 --set accuracy='10 %' --set cameras.0.samples=1 --set cameras.0.film.width=32 --set cameras.0.film.height=32 "
                            "--preview --set 'cameras.0.truth=[range, entity, temperature, normal, "
                            "area, solid_angles]' --out " +
                            folder_.string());
  ASSERT_EQ(r.code, 0) << r.output;
  const auto image = pitviper::readExr(folder_ / "seeker_00003.exr");
  EXPECT_TRUE(fs::exists(folder_ / "seeker_00003.png"));
  for (const char* name : {"mw.radiance", "lw.radiance", "vis.radiance", "truth.range", "truth.entity", "truth.temperature", "truth.area", "truth.normal_up",
                           "truth.solid_angle_of_aperture"})
    EXPECT_NE(image.find(name), nullptr) << name;
  for (const char* name : {"unit.mw.radiance", "band_um.mw.radiance", "pitviper.exposure_s", "pitviper.aperture_m", "pitviper.focal_length_m",
                           "pitviper.pose_geodetic_deg_deg_m", "pitviper.pose_ecef_m", "pitviper.orientation_ecef_wxyz", "pitviper.time_s", "pitviper.frame",
                           "pitviper.scenario", "pitviper.scenario_sha256", "pitviper.seed", "pitviper.version"})
    EXPECT_NE(image.findAttribute(name), nullptr) << name;
  const Result at = pitviper("info " + (folder_ / "seeker_00003.exr").string() + " --at 16,16");
  EXPECT_EQ(at.code, 0);
  EXPECT_NE(at.output.find("W/(m2 sr)"), std::string::npos);
  const Result info = pitviper("info " + (folder_ / "seeker_00003.exr").string());
  EXPECT_NE(info.output.find("pitviper.scenario_sha256"), std::string::npos);
}

// Stock tools read what is written.
TEST_F(Commands, ExrinfoReadsAFrame) {
  if (run("command -v exrinfo").code != 0) GTEST_SKIP() << "exrinfo (Debian package openexr) is not installed";
  ASSERT_EQ(pitviper("run " + scenario("far_jet.yaml") + " --frames 0 --out " + folder_.string()).code, 0);
  for (const auto& entry : fs::directory_iterator(folder_)) {
    if (entry.path().extension() != ".exr") continue;  // a plan lies beside it
    const Result r = run("exrinfo -v " + entry.path().string());
    EXPECT_EQ(r.code, 0) << r.output;
    EXPECT_NE(r.output.find("radiance"), std::string::npos);
  }
}

TEST_F(Commands, EveryShippedScenarioIsGood) {
  for (const auto& entry : fs::directory_iterator(std::string(PITVIPER_SOURCE_DIR) + "/scenarios"))
    if (entry.path().extension() == ".yaml") {
      // What plans are worth at what a scenario asks for is for others to see: this takes a quarter of the time.
      const Result r = pitviper("check " + entry.path().string() + " --set accuracy='10 %'");
      EXPECT_EQ(r.code, 0) << r.output;
    }
}

TEST_F(Commands, ProbesWriteTables) {
  ASSERT_EQ(pitviper("run " + scenario("lamp_on_plane.yaml") + " --out " + folder_.string()).code, 0);
  int tables = 0;
  for (const auto& entry : fs::directory_iterator(folder_))
    if (entry.path().extension() == ".csv") {
      ++tables;
      EXPECT_NE(bytes(entry.path()).find("[W/m2]"), std::string::npos);
    }
  EXPECT_GT(tables, 0);
}

// Rationale: scripts read the table. Expected: one line per row under a heading that names units. No time is held to anything: machines differ.
TEST_F(Commands, BenchWritesItsTable) {
  const Result r = pitviper("bench --factor channels --frames 10 --out " + folder_.string());
  EXPECT_NE(r.output.find("| channels | mode"), std::string::npos) << r.output;
  std::istringstream table(bytes(folder_ / "bench.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line,
            "factor,value,mode,film [px],channels,wavelengths,lights,overdraw,layers,frames,time [ms],yardstick time [ms],rate [Mpixel/s],rate [frame/s],"
            "rate by yardstick,time by base,cost per layer");
  for (const char* row : {"channels,1,direct,256,1,16,1,1,0,", "channels,1,buffered,", "channels,4,direct,", "channels,4,buffered,", "channels,16,direct,",
                          "channels,16,buffered,256,16,16,1,1,0,"}) {
    ASSERT_TRUE(std::getline(table, line));
    EXPECT_EQ(line.rfind(row, 0), 0u) << line;
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 16) << line;
    for (const char* bad : {"nan", "inf"}) EXPECT_EQ(line.find(bad), std::string::npos) << line;
  }
  EXPECT_FALSE(std::getline(table, line));
  if (fs::exists(fs::path(PITVIPER_BUILD_DIR) / "libpitviper_charts.so")) {
    EXPECT_EQ(r.code, 0) << r.output;
    EXPECT_GT(fs::file_size(folder_ / "bench.png"), 5000u);
  } else {  // the table is written all the same
    EXPECT_EQ(r.code, 2) << r.output;
    EXPECT_NE(r.output.find("libvtk9-dev"), std::string::npos);
  }
}

TEST_F(Commands, BenchKnowsItsFactors) {
  const Result r = pitviper("bench --factor chanels");
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.output.find("did you mean 'channels'?"), std::string::npos) << r.output;
  EXPECT_EQ(pitviper("bench --frames 3").code, 2);
  EXPECT_EQ(pitviper("bench --accuracy x.yaml --factor film").code, 2);
  EXPECT_EQ(pitviper("bench --accuracy x.yaml --size 1").code, 2);
  EXPECT_EQ(pitviper("bench --size 64").code, 2);
}

// Rationale: the trade of speed and accuracy is measured, not promised. Expected: a line in the table and in the CSV per setting and channel; of a
// smooth spectrum more even samples are closer to the reference, which single precision limits; what accuracy is asked for is kept.
TEST_F(Commands, BenchMeasuresAccuracyAgainstTheReference) {
  const std::string file = (folder_ / "wall.yaml").string();
  std::ofstream(file) << "name: wall\natmosphere: {extinction: {wavelength: um, unit: 1/km, values: [[2.9, 0.1], [4, 2], [13, 0.3]]}, temperature: 285 K}\n"
                         "entities: [{name: p, shape: {model: plate, width: 40 m, height: 40 m}, temperature: 300 K,\n"
                         "  material: {components: [{reflection: lambertian, reflectance: 0.2}]}}]\n"
                         "cameras: [{name: c, film: {width: 64, height: 64}, field_of_view: 4 deg, aperture: 5 mm, position: [700 m, 0 m, 0 m], look_at: p,\n"
                         "  channels: [{name: mw, response: {band: [3 um, 5 um]}}, {name: lw, response: {band: [8 um, 12 um]}}]}]\n";
  const Result r = pitviper("bench --accuracy " + file + " --size 8 --frames 1 --out " + folder_.string());
  ASSERT_TRUE(fs::exists(folder_ / "accuracy.csv")) << r.output;
  EXPECT_NE(r.output.find("8x8 pixels"), std::string::npos) << r.output;
  EXPECT_NE(r.output.find("| even 340 |"), std::string::npos) << r.output;
  std::ifstream csv(folder_ / "accuracy.csv");
  std::string line;
  std::map<std::string, double> worst;  // of a setting's channel
  std::getline(csv, line);
  while (std::getline(csv, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 15u) << line;
    EXPECT_GT(std::stod(cells[4]), 0.0) << line;
    worst[cells[1] + " " + cells[6]] = std::stod(cells[11]);
  }
  EXPECT_EQ(worst.size(), 28u);
  for (const char* channel : {"mw", "lw"}) {
    EXPECT_LT(worst[std::string("even 340 ") + channel], 5e-5) << channel;
    EXPECT_LT(worst[std::string("even 340 ") + channel], 0.1 * worst[std::string("even 4 ") + channel]) << channel;
    for (const auto& [name, accuracy] : {std::pair{"10 %", 0.1}, {"1 %", 0.01}, {"0.1 %", 0.001}})
      EXPECT_LT(worst[std::string(name) + " " + channel], accuracy) << name << " " << channel;
  }
  if (fs::exists(fs::path(PITVIPER_BUILD_DIR) / "libpitviper_charts.so")) {
    EXPECT_EQ(r.code, 0) << r.output;
    EXPECT_GT(fs::file_size(folder_ / "accuracy.png"), 5000u);
  }
}

// Rationale: a picture does not depend on how it is drawn. Expected: a frame with a canopy, plumes and smoke is the same in auto and buffered
// mode, has something of each in it, and direct mode is refused.
TEST_F(Commands, TransparentThingsAreTheSameInEitherMode) {
  const std::string line = "run " + scenario("canopy_plume_smoke.yaml") +
                           " --frames 7 --set audit=0 --set cameras.chase.film.width=48 --set cameras.chase.film.height=36 --set cameras.chase.samples=1"
                           " --set cameras.chase.spectral.samples=4 --set cameras.cockpit_view.film.width=32 --set cameras.cockpit_view.film.height=24"
                           " --set cameras.cockpit_view.samples=1 --set cameras.cockpit_view.spectral.samples=4 --set cameras.cockpit_view.small_bodies=0"
                           " --set 'cameras.chase.channels=[{name: mw, response: {band: [3.6 um, 4.9 um]}}, {name: vis, response: {band: [0.45 um, 0.75 um]}}]'"
                           " --set 'cameras.cockpit_view.channels=[{name: lw, response: {band: [8 um, 12 um]}}]' --out " +
                           folder_.string();
  ASSERT_EQ(pitviper(line + "/auto").code, 0);
  ASSERT_EQ(pitviper(line + "/buffered --set render.mode=buffered").code, 0);
  const Result direct = pitviper(line + "/direct --set render.mode=direct");
  EXPECT_EQ(direct.code, 2) << direct.output;
  for (const auto& [frame, name] :
       {std::pair{"chase_00007.exr", "mw.radiance"}, {"chase_00007.exr", "vis.radiance"}, {"cockpit_view_00007.exr", "lw.radiance"}}) {
    const auto a = pitviper::readExr(folder_ / "auto" / frame), b = pitviper::readExr(folder_ / "buffered" / frame);
    ASSERT_NE(a.find(name), nullptr);
    ASSERT_NE(b.find(name), nullptr);
    EXPECT_EQ(a.find(name)->pixels, b.find(name)->pixels) << frame << " " << name;
  }
  const auto chase = pitviper::readExr(folder_ / "auto" / "chase_00007.exr");
  const auto& mw = chase.find("mw.radiance")->pixels;
  const auto& vis = chase.find("vis.radiance")->pixels;
  EXPECT_GT(*std::max_element(mw.begin(), mw.end()), 100.0f) << "exhaust";
  EXPECT_LT(*std::min_element(vis.begin(), vis.end()), 2.0f) << "smoke";
}

// Rationale: whoever imports an atmosphere looks at it first. Expected: a summary, a table in SI units per um and a chart; one line for a
// file that is none.
TEST_F(Commands, ATape7InWordsAndTables) {
  const std::string file = (folder_ / "sun.tp7").string();
  std::ofstream(file) << "T F 6    3    3    0    6    6    6    6    6    6    1    0    0   0.000   0.00\n    1    1    1\n\n\n   36US\n"
                         "   0.00000 100.00000  20.00000 106.31252   0.32202   0.00000    0        0.00000\n\n\n"
                         "    2000.0    2500.0     500.0       1.0NW\n\n    FREQ   TRANS     SOL TR  SOLAR\n"
                         " 2000.00  0.7500 7.50E-07 1.00E-06\n 2500.00  0.5000 8.00E-07 1.60E-06\n -9999.\n";
  const Result r = pitviper("atmosphere " + file + " --out " + (folder_ / "out").string());
  EXPECT_NE(r.output.find("direct solar irradiance (IEMSCT 3)"), std::string::npos) << r.output;
  EXPECT_NE(r.output.find("path to space of 106.313 km from a height of 0 km, zenith angle 20 deg"), std::string::npos) << r.output;
  EXPECT_NE(r.output.find("mean transmittance 0.625 over 4 to 5 um"), std::string::npos) << r.output;
  EXPECT_EQ(bytes(folder_ / "out" / "sun.tp7_run1.csv"),
            "wavelength [um],wavenumber [1/cm],TRANS,SOL_TR [W/(m2 um)],SOLAR [W/(m2 um)]\n4,2500,0.5,5,10\n5,2000,0.75,3,4\n");
  const bool chart = fs::exists(folder_ / "out" / "sun.tp7_run1.png");
  EXPECT_EQ(r.code, chart ? 0 : 2) << r.output;
  EXPECT_EQ(r.output.find("libvtk9-dev") == std::string::npos, chart) << r.output;
  const Result bad = pitviper("atmosphere " + scenario("first_light.yaml"));
  EXPECT_EQ(bad.code, 2);
  EXPECT_NE(bad.output.find("first_light.yaml:1:"), std::string::npos) << bad.output;
  EXPECT_EQ(std::count(bad.output.begin(), bad.output.end(), '\n'), 1) << bad.output;
}

// Rationale: air by tables is only as good as what was typed in. Expected: how it was read and fits, with figures; a table; one line for a mistake.
TEST_F(Commands, AirFromCommaSeparatedValues) {
  const std::string file = (folder_ / "measured.csv").string();
  std::ofstream(file) << "wavelength_um,range_km,transmittance,path_radiance_W/(m2 sr um)\n4,1,0.8,0.1\n5,1,0.5,0.25\n4,2,0.64,0.18\n5,2,0.25,0.375\n";
  const Result r = pitviper("atmosphere " + file + " --out " + (folder_ / "out").string());
  EXPECT_NE(r.output.find("2 ranges, 1 to 2 km; powers of range fitted"), std::string::npos) << r.output;
  // Beer's law at both wavelengths, linear in the depth between: (0.8 + 0.5)/2 by trapezoids.
  EXPECT_NE(r.output.find("| 1 km | 0.6500 |"), std::string::npos) << r.output;
  EXPECT_EQ(bytes(folder_ / "out" / "measured.csv").rfind("wavelength [um],wavenumber [1/cm],depth of the first km of power 0.55,", 0), 0u);
  const Result bad = pitviper("atmosphere " + file + " --range 3");
  EXPECT_EQ(bad.code, 2);
  EXPECT_NE(bad.output.find("--range"), std::string::npos) << bad.output;
  std::ofstream(file) << "wavelength_um,transmittance\n4,0.8\n";
  const Result missing = pitviper("atmosphere " + file);
  EXPECT_EQ(missing.code, 2);
  EXPECT_NE(missing.output.find("measured.csv:1:15: a transmittance without a range"), std::string::npos) << missing.output;
  EXPECT_EQ(std::count(missing.output.begin(), missing.output.end(), '\n'), 1) << missing.output;
}

// Rationale: an air of others is the same whatever program wrote it. Expected: one table of transmittance for all; what is not said in a file is asked for.
TEST_F(Commands, AirOfOtherPrograms) {
  const auto put = [&](const char* name, const std::string& text) {
    const std::string file = (folder_ / name).string();
    std::ofstream(file) << text;
    return file;
  };
  // Through 2 km 0.64 at 2000 1/cm and 0.25 at 2500 1/cm, sources of 1 W/(m2 sr um).
  const std::string json =
      put("cases.json",
          R"({"MODTRAN": [{"MODTRANINPUT": {"RTOPTIONS": {"IEMSCT": "RT_THERMAL_ONLY"}, "GEOMETRY": {"ITYPE": 1, "HRANGE": 2.0}}, "MODTRANOUTPUT": {"SPECTRA":
      {"RADIANCE": {"FREQ": [2000, 2500], "TOT_TRANS": [0.64, 0.25], "THRML_EM": [9e-8, 1.2e-7], "TOTAL_RAD": [9e-8, 1.2e-7]}}}}]})");
  const std::string csv = put("case.csv", "MODTRAN 6\nfreq,total transmittance,path emission,total radiance\n2000,0.64,9e-8,9e-8\n2500,0.25,1.2e-7,1.2e-7\n");
  const std::string tape28 = put("TAPE28", "1\n0    WAVENUMBER      TRANSMISSION\n  2000.0  6.4E-01\n  2500.0  2.5E-01\n"),
                    tape27 = put("TAPE27", "1\n0    WAVENUMBER      RADIANCE\n  2000.0  9.0E-08\n  2500.0  1.2E-07\n");
  const std::string uvspec = put("slab.out", "# output_quantity transmittance\n# output_user wavenumber edir\n 2000 0.64\n 2500 0.25\n");
  const std::string bare = put("bare.dat", "2000 0.64 9e-4\n2500 0.25 1.2e-3\n");
  for (const std::string& words : {json, csv + " --range 2", tape28 + " --range 2 --radiance " + tape27, uvspec + " --range 2",
                                   bare + " --range 2 --columns 'wavenumber_1/cm, transmittance, path_radiance_W/(m2 sr cm-1)'"}) {
    const Result r = pitviper("atmosphere " + words);
    EXPECT_EQ(r.code, 0) << r.output;
    EXPECT_NE(r.output.find("exponential in range"), std::string::npos) << r.output;
    // The mean of 0.64 and 0.25 over 4 to 5 um.
    EXPECT_NE(r.output.find("| 2 km | 0.4450 |"), std::string::npos) << words << "\n" << r.output;
    EXPECT_EQ(r.output.find("no path radiance in it") == std::string::npos, words.find("slab") == std::string::npos) << r.output;
  }
  const std::pair<std::string, const char*> wrong[] = {{tape28, "TAPE28:2:1: the file does not say over which range its columns hold"},
                                                       {tape28 + " --range 2 --height 1", "--height with"},
                                                       {bare + " --columns 'wavenumber_1/cm, tau, -'", "--columns:1:18: unknown column 'tau'"},
                                                       {json + " --range 3", "the range given, 3 km, is not the 2 km of run 1"},
                                                       {json + " --height 1", "no run has a height of 1 km"}};
  for (const auto& [words, message] : wrong) {
    const Result r = pitviper("atmosphere " + words);
    EXPECT_EQ(r.code, 2) << words;
    EXPECT_NE(r.output.find(message), std::string::npos) << r.output;
  }
}

// Expected: the library's structured air with its sky and the sun, in words and as a table.
TEST_F(Commands, LibraryAirWithSkyAndSun) {
  const Result r = pitviper("atmosphere us76_rural --out " + (folder_ / "out").string());
  for (const char* part : {"| level 5 km | 0.4443 | 0.3571 |", "| sky, 90 deg up |", "| at the ground, 20 deg up |"})
    EXPECT_NE(r.output.find(part), std::string::npos) << part << "\n" << r.output;
  const std::string csv = bytes(folder_ / "out" / "us76_rural.csv");
  EXPECT_NE(csv.find(",sky radiance 20 deg up [W/(m2 sr um)]"), std::string::npos);
  EXPECT_GT(std::count(csv.begin(), csv.end(), '\n'), 1200);
}

// The parts of a pixel, of the frame's own scenario alone.
TEST_F(Commands, TermsOfAPixel) {
  std::ofstream(folder_ / "plate.yaml")
      << "sun: {azimuth: 90 deg, elevation: 30 deg, irradiance: 20 W/(m2 um)}\n"
         "entities: [{name: wall, shape: {model: plate, width: 40 m, height: 40 m}, material: sand, temperature: 300 K}]\n"
         "cameras: [{name: c, film: {width: 4, height: 4}, field_of_view: 1 deg, aperture: 20 mm, position: [10 m, 0 m, 0 m],\n"
         "           look_at: [0 m, 0 m, 0 m], channels: [{name: lw, response: {band: [8 um, 9 um]}}]}]\n";
  const std::string file = (folder_ / "plate.yaml").string(), frame = (folder_ / "out" / "c_00000.exr").string();
  ASSERT_EQ(pitviper("run " + file + " --out " + (folder_ / "out").string()).code, 0);
  const Result told = pitviper("info " + frame + " --at 1,2 --terms " + file);
  EXPECT_EQ(told.code, 0) << told.output;
  for (const char* word : {"emission of surfaces: wall", "reflected sunlight: wall", "all of it", "this frame", "lw.radiance [W/(m2 sr)]"})
    EXPECT_NE(told.output.find(word), std::string::npos) << word << "\n" << told.output;
  const Result other = pitviper("info " + frame + " --at 1,2 --terms " + file + " --set entities.wall.temperature='301 K'");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.output.find("not a frame of"), std::string::npos) << other.output;
  EXPECT_EQ(pitviper("info " + frame + " --terms " + file).code, 2) << "no pixel";
  EXPECT_EQ(pitviper("info " + frame + " --at 1,2 --set a=b").code, 2) << "no scenario";
}

}  // namespace
