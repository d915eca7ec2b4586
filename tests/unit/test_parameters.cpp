// Units, values and tables.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "scenarios/reader/scenario_reader.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "scenarios/sweep/sweep_file.hpp"
#include "sim/parameters/spectrum_value.hpp"
#include "sim/parameters/time_course.hpp"
#include "sim/parameters/units.hpp"
#include "sim/scene/motion.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

double in(const char* text, const char* unit) { return convert(*splitQuantity(text), unit).value(); }

TEST(Units, Conversions) {
  EXPECT_DOUBLE_EQ(in("3.5 um", "um"), 3.5);
  EXPECT_DOUBLE_EQ(in("3500 nm", "um"), 3.5);
  EXPECT_DOUBLE_EQ(in("62 degC", "K"), 335.15);
  EXPECT_NEAR(in("212 degF", "K"), 373.15, 1e-9);
  EXPECT_DOUBLE_EQ(in("0.2 /km", "1/m"), 2e-4);
  EXPECT_DOUBLE_EQ(in("2 W/(cm2 sr um)", "W/(m2 sr um)"), 2e4);
  EXPECT_DOUBLE_EQ(in("2 W m-2 sr-1 um-1", "W/(m2 sr um)"), 2.0);
  EXPECT_DOUBLE_EQ(in("12 kW/sr", "W/sr"), 12000.0);
  EXPECT_NEAR(in("90 deg", "rad"), 1.5707963267948966, 1e-15);
  EXPECT_DOUBLE_EQ(in("36 km/h", "m/s"), 10.0);
  EXPECT_DOUBLE_EQ(in("5 %", ""), 0.05);
  EXPECT_DOUBLE_EQ(in("3 lx", "lm/m2"), 3.0);
  EXPECT_DOUBLE_EQ(in("2e6 V/W", "V/W"), 2e6);
}

TEST(Units, RefusesWhatIsNot) {
  EXPECT_FALSE(parseUnit("furlong"));
  EXPECT_FALSE(parseUnit("W/(m2"));
  EXPECT_FALSE(parseUnit("m//s"));
  EXPECT_FALSE(splitQuantity("nan K"));
  EXPECT_FALSE(splitQuantity("1e999 K"));
  EXPECT_FALSE(splitQuantity("warm"));
  EXPECT_FALSE(convert(*splitQuantity("3 K"), "um"));
  EXPECT_FALSE(convert(*splitQuantity("3"), "um"));
}

std::string errorOf(const std::string& yaml) {
  try {
    scene(yaml);
  } catch (const UserError& e) {
    return e.what();
  }
  return "no error";
}

const std::string kCamera =
    "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 2 deg, aperture: 20 mm, heading: 0 deg, channels: [{name: a, response: {band: [3 um, 5 "
    "um]}}]}]\n";

TEST(Reader, PlacesAndFixes) {
  EXPECT_EQ(errorOf("sede: 3\n" + kCamera).rfind("test.yaml:1:1: unknown key 'sede'", 0), 0u);
  EXPECT_NE(errorOf("sede: 3\n" + kCamera).find("did you mean 'seed'"), std::string::npos);
  EXPECT_EQ(errorOf("seed: 3\nseed: 4\n" + kCamera).rfind("test.yaml:2:1: duplicate key", 0), 0u);
  EXPECT_EQ(errorOf("background: {temperature: 300}\n" + kCamera).rfind("test.yaml:1:27: temperature has no unit", 0), 0u);
  EXPECT_EQ(errorOf("background: {temperature: 300 m}\n" + kCamera).rfind("test.yaml:1:27: temperature has the wrong unit", 0), 0u);
  EXPECT_NE(errorOf("lights: []\n").find("neither a camera nor a probe"), std::string::npos);
}

struct Sample {
  double range_m = 7.0;
  std::optional<double> gain = {};
  int count = 3;
  bool open = false;
  std::string name = "none";
  glm::dvec3 at{1.0, 2.0, 3.0};
  TimeCourse level;
  AtEnd end = AtEnd::Hold;
};
struct Other {
  double range_m = 5.0;
};

// A key is one row: what a user writes goes into the member that its row names, in the row's unit; what is absent leaves members as they are, or has the row's
// default.
TEST(Parameters, AKeyGoesIntoTheMemberOfItsRow) {
  const ParameterTable table{
      "sample",
      "",
      {number("range", "m", "", &Sample::range_m), number("gain", "", "", &Sample::gain), withDefault(integer("count", "", 0, 100, &Sample::count), "9"),
       boolean("open", "", &Sample::open), text("name", "", &Sample::name), vector3("at", "m", "", &Sample::at), course("level", "W", "", &Sample::level),
       choice("end", {{"hold", AtEnd::Hold}, {"loop", AtEnd::Loop}}, "", &Sample::end), number("far", "m", "", &Other::range_m)}};
  const TemporaryFolder folder;
  const auto read = [&](const std::string& yaml, auto object) {
    const Value tree = loadYaml(folder.put("a.yaml", yaml), {});
    Record(tree, table).fill(object);
    return object;
  };
  const Sample all =
      read("{range: 2 km, gain: 50 %, count: 4, open: true, name: x, at: [1 m, 2 cm, 3 km], level: [[0 s, 1 W], [2 s, 3 W]], end: loop, far: 1 m}", Sample{});
  EXPECT_DOUBLE_EQ(all.range_m, 2000.0);
  EXPECT_DOUBLE_EQ(all.gain.value(), 0.5);
  EXPECT_EQ(all.count, 4);
  EXPECT_TRUE(all.open);
  EXPECT_EQ(all.name, "x");
  EXPECT_DOUBLE_EQ(all.at.y, 0.02);
  EXPECT_DOUBLE_EQ(all.level.at(1.0), 2.0);
  EXPECT_EQ(all.end, AtEnd::Loop);
  const Sample none = read("{far: 3 m}", Sample{});
  EXPECT_DOUBLE_EQ(none.range_m, 7.0);
  EXPECT_FALSE(none.gain);
  EXPECT_EQ(none.count, 9) << "the row's default";
  EXPECT_EQ(none.name, "none");
  EXPECT_EQ(none.end, AtEnd::Hold);
  EXPECT_DOUBLE_EQ(read("{far: 3 m, range: 1 m}", Other{}).range_m, 3.0) << "rows of another struct leave it alone";
  EXPECT_NE(describe(table).find("| `end` | choice |  | - | hold, loop |"), std::string::npos) << describe(table);
}

// What would be ignored is refused, and what people mean is suggested.
TEST(Reader, NothingIsIgnoredSilently) {
  const std::string head = "entities: [{name: p, material: blackbody, temperature: 300 K, shape: {model: ";
  EXPECT_NE(errorOf(head + "cylinder, radius: 1 m, height: 2 m}}]\n" + kCamera).find("a cylinder has no 'height'"), std::string::npos);
  EXPECT_NE(errorOf(head + "plate, width: 1 m, height: 1 m}, heading: 3 deg, motion: [{time: 0 s, position: [0 m, 0 m, 0 m]}]}]\n" + kCamera)
                .find("a heading and a motion"),
            std::string::npos);
  EXPECT_NE(errorOf("cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 2 deg, aperture: 20 mm, heading: 0 deg, look_at: [1 m, 0 m, 0 m], "
                    "channels: [{name: a, response: {band: [3 um, 5 um]}}]}]\n")
                .find("a heading and a look_at"),
            std::string::npos);
  EXPECT_NE(
      errorOf("entities: [{name: p, material: grass, temperature: 300 K, shape: {model: plate, width: 1 m, height: 1 m}}]\n" + kCamera).find("'dry_grass'"),
      std::string::npos);
  EXPECT_NE(errorOf("background: {temperature: 14 C}\n" + kCamera).find("write it in K or degC"), std::string::npos);
}

// A zero angle is no angle.
TEST(Reader, WritingAZeroAngleTurnsNothing) {
  const std::string head = "entities: [{name: p, material: blackbody, temperature: 300 K, shape: {model: plate, width: 1 m, height: 1 m}";
  for (const char* angle : {"", ", pitch: 0 deg", ", roll: 0 deg", ", heading: 90 deg"}) {
    const glm::dvec3 x = scene(head + angle + "}]\n" + kCamera).entities[0].motion.at(0.0).orientation * glm::dvec3(1, 0, 0);
    EXPECT_LT(glm::length(x - glm::dvec3(1, 0, 0)), 1e-12) << angle;
  }
}

TEST(Reader, WavenumberTablesAreTurnedRound) {
  const auto sim = scene("background: {radiance: {wavelength: 1/cm, unit: W/(m2 sr um), values: [[1000, 1], [2000, 2], [5000, 5]]}}\n" + kCamera);
  EXPECT_NEAR(sim.background(10.0), 1.0, 1e-12);
  EXPECT_NEAR(sim.background(5.0), 2.0, 1e-12);
  EXPECT_NEAR(sim.background(2.0), 5.0, 1e-12);
}

TEST(Reader, OverridesReachListsByNameAndNumber) {
  Value tree = parseYaml("cameras: [{name: c, samples: 1}]\n", "x");
  applyOverride(tree, "cameras.c.samples=2");
  EXPECT_EQ(tree.entries[0].second.items[0].find("samples")->text, "2");
  applyOverride(tree, "cameras.0.exposure=3 ms");
  EXPECT_EQ(tree.entries[0].second.items[0].find("exposure")->text, "3 ms");
  applyOverride(tree, "cameras.c.spectral.samples=8");
  EXPECT_EQ(tree.entries[0].second.items[0].find("spectral")->find("samples")->text, "8");
  EXPECT_THROW(applyOverride(tree, "cameras.9.samples=2"), UserError);
  EXPECT_THROW(applyOverride(tree, "samples"), UserError);
}

TEST(Reader, EveryLibraryFileIsGood) {
  const std::filesystem::path home = PITVIPER_SOURCE_DIR;
  int count = 0;
  auto names = [](const std::filesystem::path& folder) {
    std::vector<std::string> all;
    for (const auto& e : std::filesystem::directory_iterator(folder))
      if (e.path().extension() == ".yaml") all.push_back(e.path().stem().string());
    return all;
  };
  for (const auto& n : names(home / "materials/library")) {
    EXPECT_NO_THROW(scene("entities: [{name: p, shape: {model: sphere, radius: 1 m}, material: " + n + ", temperature: 300 K}]\n" + kCamera)) << n;
    ++count;
  }
  for (const auto& n : names(home / "atmosphere/library")) {
    EXPECT_NO_THROW(scene("atmosphere: " + n + "\n" + kCamera)) << n;
    ++count;
  }
  EXPECT_GT(count, 20);
}

// The key reference in scenarios/README.md is what the reader accepts.
TEST(Reader, KeyReferenceIsCurrent) {
  std::ifstream in(std::string(PITVIPER_SOURCE_DIR) + "/scenarios/README.md");
  std::stringstream text;
  text << in.rdbuf();
  const std::string readme = text.str();
  const size_t begin = readme.find("<!-- keys -->\n"), end = readme.find("<!-- end of keys -->");
  ASSERT_NE(begin, std::string::npos);
  ASSERT_NE(end, std::string::npos);
  EXPECT_TRUE(readme.substr(begin + 14, end - begin - 14) == keyReference() + sweepKeyReference())
      << "run: pitviper keys, and put its output between the marks in scenarios/README.md";
}

}  // namespace
}  // namespace pitviper::test
