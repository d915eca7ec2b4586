// `plumes:` of a scenario: what becomes of it, and what is said of what is wrong.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "materials/fields/grid_field.hpp"
#include "materials/fields/jets.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/parameters/module_on_demand.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

const char* const kScene = R"(
entities:
  - {name: jet, shape: {model: jet}, material: {components: [{reflection: lambertian, reflectance: 0.2}]}, temperature: 300 K, position: [0 m, 0 m, 3000 m]}
  - {name: missile, shape: {model: missile}, material: {components: [{reflection: lambertian, reflectance: 0.2}]}, temperature: 300 K,
     begin: 2 s, position: [0 m, 99 m, 3000 m]}
cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 2 deg, aperture: 10 mm, look_at: jet, position: [-500 m, 0 m, 3000 m],
  channels: [{name: a, response: {band: [3 um, 5 um]}}]}]
plumes:
)";

Simulation with(const std::string& plumes) { return scene(kScene + plumes); }

/// What is said of a plume, or nothing.
std::string said(const std::string& plumes) {
  try {
    with(plumes);
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

const JetsSource& jetsOf(const Simulation& s, std::size_t field = 0) { return dynamic_cast<const JetsSource&>(*s.fields[field].source); }

TEST(PlumeReader, EnginesAndMotors) {
  const Simulation s = with(R"(
  - {name: exhaust, on: jet, engine: turbofan_afterburner, nozzles: [[-7.3 m, 0.55 m, 0 m], [-7.3 m, -0.55 m, 0 m]], throttle: [[0 s, 0], [2 s, 1]],
     length: 50 m}
  - {name: motor, on: missile, engine: aluminised_motor, position: [-1.43 m, 0 m, 0 m]}
)");
  ASSERT_EQ(s.fields.size(), 2u);
  EXPECT_EQ(s.fields[0].name, "exhaust");
  std::vector<std::string> gases;
  for (const FieldGas& g : s.fields[0].gases) {
    gases.push_back(g.name);
    ASSERT_FALSE(g.levels.empty());
    for (std::size_t i = 0; i < g.levels.size(); ++i) {
      ASSERT_TRUE(s.materials[static_cast<std::size_t>(g.levels[i].material)]->medium);
      if (i > 0) {
        EXPECT_GT(g.levels[i].temperature_K, g.levels[i - 1].temperature_K);
      }
    }
  }
  EXPECT_EQ(gases, (std::vector<std::string>{"CO2", "H2O", "CO", "soot"}));
  EXPECT_EQ(s.fields[0].gases[3].levels.size(), 1u);
  const JetsSource& exhaust = jetsOf(s);
  EXPECT_EQ(exhaust.setup().nozzles.size(), 2u);
  EXPECT_EQ(exhaust.setup().length_m, 50.0);
  EXPECT_EQ(exhaust.conditionsAt(1.0, 3000.0, 0.0)->throttle, 1000);
  // The motor is lit as its body comes, at 2 s; it burns for 8.
  EXPECT_FALSE(jetsOf(s, 1).conditionsAt(1.9, 3000.0, 0.0));
  EXPECT_TRUE(jetsOf(s, 1).conditionsAt(9.9, 3000.0, 0.0));
  EXPECT_FALSE(jetsOf(s, 1).conditionsAt(10.2, 3000.0, 0.0));
  // Both have levels of carbon dioxide in common: a material once.
  std::map<std::string, int> count;
  for (const auto& m : s.materials) EXPECT_EQ(++count[m->name], 1) << m->name;
  for (const char* engine : {"turbofan_military", "small_turbojet", "turboshaft", "reduced_smoke_motor", "double_base_motor"})
    EXPECT_EQ(with(std::string("  - {name: p, on: jet, engine: ") + engine + "}\n").fields.size(), 1u);
}

TEST(PlumeReader, ANozzleWrittenOut) {
  const Simulation s = with(R"(
  - name: stand
    position: [10 m, 20 m, 5 m]
    direction: [0, 1, 0]
    nozzle: {diameter: 20 cm, temperature: 1200 K, speed: 500 m/s, species: {co2: 4 %, h2o: 0.05, soot: 1e-5}}
    throttle: 0.5
    begin: 1 s
    end: 3 s
)");
  const JetsSetup& j = jetsOf(s).setup();
  ASSERT_TRUE(j.nozzle);
  EXPECT_DOUBLE_EQ(j.nozzle->diameter_m, 0.2);
  EXPECT_DOUBLE_EQ(j.nozzle->gas.co2, 0.04);
  EXPECT_EQ(j.entity, -1);
  EXPECT_EQ(j.nozzles[0], glm::dvec3(10, 20, 5));
  EXPECT_EQ(s.fields[0].gases.size(), 3u);
  EXPECT_FALSE(jetsOf(s).conditionsAt(0.5, 0.0, 0.0));
  EXPECT_EQ(jetsOf(s).conditionsAt(2.0, 0.0, 0.0)->throttle, 1000);
}

// Each with file, line and column, what was expected, and the fix.
TEST(PlumeReader, WhatIsWrongIsNamed) {
  const std::string ok = "nozzle: {diameter: 0.2 m, temperature: 900 K, speed: 500 m/s, species: {co2: 0.05}}";
  EXPECT_EQ(said("  - {name: p, on: jet, " + ok + "}\n"), "");
  struct Case {
    std::string plume, wrong, fix;
  };
  const std::vector<Case> cases = {
      {"{name: p, on: jet}", "a plume without a nozzle", "add 'engine: turbofan_military'"},
      {"{name: p, " + ok + "}", "a plume from nowhere", "add 'on: <entity>'"},
      {"{name: p, on: jat, " + ok + "}", "there is no entity 'jat'", "did you mean 'jet'"},
      {"{name: p, on: jet, engine: turbofan_militry}", "there is no engine 'turbofan_militry'", "did you mean 'turbofan_military'"},
      {"{name: p, on: jet, engine: turboshaft, " + ok + "}", "a plume of several kinds", "remove the others"},
      {"{name: p, on: jet, nozzle: {diameter: 0.2 m, temperature: 3500 K, speed: 500 m/s, species: {co2: 0.05}}}", "hotter than the tables",
       "not that of the chamber"},
      {"{name: p, on: jet, nozzle: {diameter: 0.2 m, temperature: 900 K, speed: 500 m/s, species: {oxygen: 0.05}}}", "nothing in this exhaust emits",
       "add 'co2: 0.05'"},
      {"{name: p, on: jet, nozzle: {diameter: 0.2 m, temperature: 900 K, speed: 500 m/s, species: {co2: 0.6, h2o: 0.6}}}", "add up to 1.2", "lower them"},
      {"{name: p, on: jet, nozzle: {temperature: 900 K, speed: 500 m/s, species: {co2: 0.6}}}", "diameter", ""},
      {"{name: p, on: jet, nozzle: {diameter: 0 m, temperature: 900 K, speed: 500 m/s, species: {co2: 0.6}}}", "diameter", ""},
      {"{name: p, on: jet, position: [0 m, 0 m, 0 m], nozzles: [[1 m, 0 m, 0 m]], " + ok + "}", "'nozzles' and a 'position'", "remove one"},
      {"{name: p, on: jet, direction: [0, 0, 0], " + ok + "}", "without a direction", "[-1, 0, 0]"},
      {"{name: p, on: jet, throttle: 1.2, " + ok + "}", "throttle", ""},
      {"{name: p, on: jet, throttle: [[2 s, 1], [1 s, 0]], " + ok + "}", "", ""},
      {"{name: p, on: jet, begin: 3 s, end: 2 s, " + ok + "}", "ends before it begins", "exchange them"},
      {"{name: p, on: missile, end: 1 s, " + ok + "}", "isn't there while it should have a plume", "here or there"},
      {"{name: p, on: jet, length: -3 m, " + ok + "}", "length", ""},
      {"{name: p, on: jet, grid: {file: none.vti, arrays: {temperature: T}}}", "a grid of nothing that emits", "add 'co2"},
      {"{name: p, on: jet, throttle: 0.5, grid: {file: none.vti, arrays: {temperature: T, co2: C}}}", "'throttle' of a grid", "remove it"},
      {"{name: p, on: jet, grid: {file: none.vti, arrays: {temperature: T, co2: C}}}", "none.vti", ""},
      {"{name: p, on: jet, speed: 4, " + ok + "}", "speed", ""},
  };
  for (const Case& c : cases) {
    const std::string text = said("  - " + c.plume + "\n");
    EXPECT_NE(text, "") << c.plume;
    EXPECT_NE(text.find(c.wrong), std::string::npos) << text;
    EXPECT_NE(text.find(c.fix), std::string::npos) << text;
    EXPECT_NE(text.find(":9:"), std::string::npos) << text;  // the plume's line
  }
  EXPECT_NE(said("  - {name: p, on: jet, " + ok + "}\n  - {name: p, on: jet, " + ok + "}\n").find("'p'"), std::string::npos);
}

/// A 3x3x3 grid whose values may be spoilt.
std::string cube(double temperature_K, double middle, const char* gas = "X_CO2") {
  std::string t, g;
  for (int i = 0; i < 27; ++i) {
    t += " " + std::to_string(temperature_K + i);
    g += i == 13 ? " " + std::to_string(middle) : " 0.01";
  }
  return std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">\n") +
         "<ImageData WholeExtent=\"0 2 0 2 0 2\" Origin=\"0 0 0\" Spacing=\"1 1 1\">\n<Piece Extent=\"0 2 0 2 0 2\">\n<PointData>\n" +
         "<DataArray type=\"Float32\" Name=\"T\" format=\"ascii\">" + t + "</DataArray>\n<DataArray type=\"Float32\" Name=\"" + gas + "\" format=\"ascii\">" +
         g + "</DataArray>\n</PointData>\n</Piece>\n</ImageData>\n</VTKFile>\n";
}

TEST(PlumeReader, AGridFromAFile) {
  if (!std::filesystem::exists(std::filesystem::path(PITVIPER_BUILD_DIR) / "libpitviper_mesh_import.so")) GTEST_SKIP() << "built without VTK";
  setModuleFolder(PITVIPER_BUILD_DIR);
  const TemporaryFolder folder;
  const auto asked = [&](const std::string& name, const std::string& more = "") {
    return "  - {name: p, on: jet, position: [-8 m, 0 m, 0 m], grid: {file: " + (folder.path() / name).string() + ", unit: 10 cm, forward: -x" + more +
           ", arrays: {temperature: T, co2: X_CO2}}}\n";
  };
  folder.put("good.vti", cube(600.0, 0.05));
  const Simulation s = with(asked("good.vti"));
  ASSERT_EQ(s.fields.size(), 1u);
  EXPECT_EQ(s.fields[0].gases.size(), 1u);
  const auto state = dynamic_cast<const GridSource&>(*s.fields[0].source).state();
  EXPECT_NEAR(state->high.x, 0.2, 1e-12);
  std::vector<FieldStep> steps;
  state->along({{0.1, 0.1, -1.0}, {0.0, 0.0, 1.0}, 0.0, 5.0}, 40, steps);
  double amount = 0.0;
  for (const FieldStep& f : steps) amount += f.amount[0];
  EXPECT_NEAR(amount, (0.5 * (0.01 + 0.05) - 0.00042) * 0.2, 1e-6);  // trapezes of nodes; 1 atm; the air's own taken off

  folder.put("cold.vti", cube(10.0, 0.05));
  EXPECT_NE(said(asked("cold.vti")).find("cold.vti: array 'T' is 10 K at node [0, 0, 0]"), std::string::npos) << said(asked("cold.vti"));
  folder.put("less.vti", cube(600.0, -0.05));
  EXPECT_NE(said(asked("less.vti")).find("array 'X_CO2' is -0.05 at node [1, 1, 1]"), std::string::npos) << said(asked("less.vti"));
  folder.put("more.vti", cube(600.0, 1.5));
  EXPECT_NE(said(asked("more.vti")).find("expected 0 to 1"), std::string::npos);
  folder.put("other.vti", cube(600.0, 0.05, "Y"));
  EXPECT_NE(said(asked("other.vti")).find("no array 'X_CO2'"), std::string::npos);
  EXPECT_NE(said(asked("good.vti", ", up: -x")).find("same axis"), std::string::npos);
  setModuleFolder({});
}

// The example of scenarios/README.md is read as it stands there.
TEST(PlumeReader, TheReadmesExampleIsRead) {
  std::ifstream in(std::filesystem::path(PITVIPER_SOURCE_DIR) / "scenarios/README.md");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::size_t section = text.find("## Plumes"), begin = text.find("```yaml\n", section) + 8, end = text.find("```", begin);
  ASSERT_NE(section, std::string::npos);
  const std::string example = text.substr(begin, end - begin);
  ASSERT_NE(example.find("plumes:"), std::string::npos);
  const Simulation s = scene(std::string(kScene).substr(0, std::string(kScene).find("plumes:")) + example);
  EXPECT_EQ(s.fields.size(), 3u);
}

}  // namespace
}  // namespace pitviper::test
