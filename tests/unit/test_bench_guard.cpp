// Figures that are held against a file: how the file is read, what is named, and the changes of scenarios that are measured.
#include <gtest/gtest.h>

#include "scenarios/commands/first_figures.hpp"
#include "scenarios/commands/guard_bench.hpp"
#include "scenarios/commands/run_timing.hpp"
#include "scenarios/commands/scenario_changes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

std::string errorOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(BenchGuard, TheShippedFileIsGood) {
  const auto lines = readGuardFile(std::filesystem::path(PITVIPER_SOURCE_DIR) / "tests/bench_guard.csv");
  EXPECT_GT(lines.size(), 10u);
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [](const GuardLine& l) { return l.quick && l.subject == GuardSubject::Scenario; }));
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [](const GuardLine& l) { return l.subject == GuardSubject::Folder; }));
}

TEST(BenchGuard, ALineIsReadCellByCell) {
  const TemporaryFolder folder;
  folder.put("a.yaml", "name: a\n");
  std::filesystem::create_directories(folder.path() / "code");
  const auto lines = readGuardFile(folder.put("g.csv",
                                              "# of nothing\n\nquick, a.yaml, first, planning_work, 1.5e1, slow, but it is known\n"
                                              "all,code,,lines,100,small\r\n  all, bench, film/64/direct, by_yardstick, 0.6, of a new one\n"));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(lines[0].quick);
  EXPECT_EQ(lines[0].path, folder.path() / "a.yaml");
  EXPECT_EQ(lines[0].label(), "a.yaml, first, planning_work");
  EXPECT_EQ(lines[0].value, 15.0);
  EXPECT_EQ(lines[0].reason, "slow, but it is known");
  EXPECT_EQ(lines[1].subject, GuardSubject::Folder);
  EXPECT_EQ(lines[1].reason, "small");
  EXPECT_EQ(lines[2].subject, GuardSubject::Bench);
}

TEST(BenchGuard, WhatIsNotAsExpectedIsToldWithItsPlace) {
  const TemporaryFolder folder;
  folder.put("a.yaml", "name: a\n");
  std::filesystem::create_directories(folder.path() / "code");
  const std::pair<const char*, const char*> cases[] = {
      {"sometimes, a.yaml, first, groups, 1, x", "g.csv:1:1: there is no set 'sometimes'; expected one of quick, all"},
      {"all, b.yaml, first, groups, 1, x", "g.csv:1:6: there is neither a file nor a folder 'b.yaml'"},
      {"all, a.yaml, frist, groups, 1, x", "g.csv:1:14: there is no state of a scenario 'frist'"},
      {"all, a.yaml, first, group, 1, x", "did you mean 'groups'?"},
      {"all, a.yaml, first, groups, 1 s, x", "g.csv:1:29: '1 s' is no value of a figure"},
      {"all, a.yaml, first, groups, -1, x", "'-1' is no value of a figure"},
      {"all, a.yaml, first, groups, nan, x", "'nan' is no value of a figure"},
      {"all, a.yaml, first, groups, 1,", "the figure has no reason"},
      {"all, a.yaml, first, groups, 1", "g.csv:1:1: 5 cells; expected 6"},
      {"all, code, first, lines, 1, x", "a folder of sources has no state"},
      {"all, code, , groups, 1, x", "there is no figure of a folder 'groups'"},
      {"all, bench, centre/wall/direct, by_yardstick, 1, x", "there is no row of bench 'centre/wall/direct'"},
      {"all, a.yaml, first, groups, 1, x\nall, a.yaml, first, groups, 2, y", "g.csv:2:6: the figure 'a.yaml, first, groups' is there twice"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string said = errorOf([&] { readGuardFile(folder.put("g.csv", text)); });
    EXPECT_NE(said.find(expected), std::string::npos) << text << "\n" << said;
  }
}

GuardResult result(double file, std::optional<double> now) {
  GuardLine line;
  line.name = "a.yaml";
  line.state = "first";
  line.figure = "groups";
  line.value = file;
  line.reason = "as ever";
  return {line, now, "no air"};
}

TEST(BenchGuard, MoreThanAFifthIsNamed) {
  EXPECT_FALSE(hasGrown(result(10.0, 11.99)) || hasShrunk(result(10.0, 11.99)));
  EXPECT_TRUE(hasGrown(result(10.0, 12.01)));
  EXPECT_FALSE(hasShrunk(result(10.0, 8.01)));
  EXPECT_TRUE(hasShrunk(result(10.0, 7.99)));
  EXPECT_TRUE(hasGrown(result(0.0, 1.0))) << "of what was nothing";
  EXPECT_FALSE(hasGrown(result(0.0, 0.0)));
  EXPECT_FALSE(hasGrown(result(10.0, std::nullopt)));
  const std::string text = guardText({result(10.0, 15.0), result(10.0, 5.0), result(10.0, 10.0), result(10.0, std::nullopt)}, "g.csv");
  EXPECT_NE(text.find("\ngrown: a.yaml, first, groups: 15, 10 in the file (+50 %): as ever\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nbetter, write it down: a.yaml, first, groups: 5, 10 in the file (-50 %): as ever\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nnot measured: a.yaml, first, groups: no air\n"), std::string::npos) << text;
  EXPECT_NE(text.find("4 figures of g.csv: 1 grown by more than a fifth, 1 shrunk by more than a fifth, 1 not measured"), std::string::npos) << text;
}

TEST(BenchGuard, LinesOfCodeAreThoseThatAreNotBlank) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "inner");
  folder.put("a.cpp", "int a;\n\n  \t\nint b;  // and more\n");
  folder.put("inner/b.glsl", "float c;");
  folder.put("inner/c.hpp", "\n\n");
  folder.put("d.md", "words\n");
  EXPECT_EQ(codeLines(folder.path()), 3);
}

TEST(BenchGuard, AFigureIsReadBackAmongOtherWords) {
  const FirstFigures all{{"groups", 12.0}, {"planning", 0.123456789}};
  EXPECT_EQ(readFigures("note: no room\n" + writeFigures(all) + "figure\nfigure x\nfigures y 1\n"), all);
}

TEST(BenchGuard, PartsOfTheTimeBeforeAPictureHaveAStage) {
  EXPECT_EQ(stageOf("preparing"), "tables");
  EXPECT_EQ(stageOf("preparing: planning"), "planning");
  EXPECT_EQ(stageOf("preparing: programs"), "programs");
  EXPECT_EQ(stageOf("first frame: shading: programs"), "programs");
  EXPECT_EQ(stageOf("first frame: shading"), "first_frame");
  EXPECT_EQ(stageOf("shading"), "");
}

constexpr const char* kCamera =
    "cameras:\n  - {name: c, film: {width: 8, height: 8}, field_of_view: 5 deg, aperture: 5 cm, position: [0 m, 0 m, 50 m], look_at: %, channels: [{name: mw, "
    "response: {band: [4 um, 4.1 um]}}]}\n";

std::vector<ScenarioChange> changesOfText(const std::string& body, const std::string& target) {
  const TemporaryFolder folder;
  std::string camera = kCamera;
  camera.replace(camera.find('%'), 1, target);
  return changesOf({folder.put("s.yaml", body + camera)});
}

std::string wordsOf(const std::vector<ScenarioChange>& changes, const std::string& name) {
  for (const ScenarioChange& c : changes)
    if (c.name == name) return (c.sets.empty() ? "none: " : "") + c.words;
  return "";
}

TEST(BenchChanges, OfTheBodyThatACameraLooksAt) {
  const auto changes = changesOfText(
      "atmosphere: hazy_us76\naccuracy: 4 %\nentities:\n  - {name: field, shape: {model: plate, width: 9 m, height: 9 m}, material: flat_black_paint, "
      "temperature: 280 K, position: [1 m, 2 m, "
      "3 m]}\n  - {name: ball, shape: {model: sphere, radius: 1 m}, material: olive_gloss_paint, temperature: 27 degC, position: [10 m, 300 m, 40 m]}\n",
      "ball");
  EXPECT_EQ(wordsOf(changes, "temperature"), "entities.ball.temperature 27 degC -> 310.15 K");
  EXPECT_EQ(wordsOf(changes, "visibility"), "atmosphere hazy_us76 -> {library: hazy_us76, visibility: 15 km}");
  EXPECT_EQ(wordsOf(changes, "field_of_view"), "cameras.c.field_of_view 5 deg -> 4 deg");
  EXPECT_EQ(wordsOf(changes, "position"), "entities.ball.position.0 10 m -> 11 m");
  EXPECT_EQ(wordsOf(changes, "material"), "entities.ball.material olive_gloss_paint -> grey_aircraft_paint");
  EXPECT_EQ(wordsOf(changes, "accuracy"), "accuracy 4 % -> 2 %");
}

TEST(BenchChanges, WhatAScenarioCannotHaveIsSaid) {
  const auto changes = changesOfText(
      "atmosphere: {extinction: 0.1 /km, temperature: 288 K}\nentities:\n  - {name: ball, shape: {model: plate, width: 1 m, height: 1 m}, material: "
      "flat_black_paint, temperature: {file: " PITVIPER_SOURCE_DIR
      "/scenarios/assets/terrain_near_temperature.png, minimum: 280 K, maximum: 300 K}, position: [10 m, 300 m, 40 m]}\n",
      "ball");
  EXPECT_EQ(wordsOf(changes, "temperature"), "none: no body has a temperature that can be 10 K more");
  EXPECT_TRUE(wordsOf(changes, "visibility").starts_with("none: ")) << wordsOf(changes, "visibility");
  EXPECT_EQ(wordsOf(changes, "accuracy"), "none: no accuracy is asked for");
  EXPECT_EQ(wordsOf(changes, "material"), "entities.ball.material flat_black_paint -> olive_gloss_paint");
}

TEST(BenchChanges, OfWhatIsWarmedByAirOrOverTime) {
  const std::string body = "atmosphere: clear_us76\norigin: {latitude: 50 deg, longitude: 8 deg}\n", jet =
    "entities:\n  - {name: jet, shape: {model: jet}, material: grey_aircraft_paint, position: [0 m, 1 km, 90 m], temperature: ";
  EXPECT_EQ(wordsOf(changesOfText(body + jet + "{recovery: turbulent}}\n", "jet"), "temperature"), "entities.jet.temperature.offset 0 K -> 10 K");
  EXPECT_EQ(wordsOf(changesOfText(body + jet + "{recovery: turbulent, offset: -15 K}}\n", "jet"), "temperature"),
            "entities.jet.temperature.offset -15 K -> -5 K");
  EXPECT_EQ(wordsOf(changesOfText(body + jet + "[[0 s, 290 K], [1 s, 300 K]]}\n", "jet"), "temperature"), "entities.jet.temperature.0.1 290 K -> 300 K");
}

TEST(BenchChanges, OfAWayOfAPartAndOfAMap) {
  const auto changes = changesOfText(
      "atmosphere: {library: hazy_us76, visibility: 8 km}\naccuracy: {asked: 2 %, at_most: 8 %}\nentities:\n  - name: jet\n    shape: {model: jet}\n    "
      "material: {components: []}\n"
      "    temperature: {over: [[0 s, 300 K], [1 s, 310 K]]}\n    parts: {nozzle: {temperature: 800 K}}\n    motion: [{time: 0 s, position: [0 m, 1 km, 90 "
      "m]}, {time: 1 s, position: [9 m, 1 km, 90 m]}]\n",
      "jet");
  EXPECT_EQ(wordsOf(changes, "temperature"), "entities.jet.parts.nozzle.temperature 800 K -> 810 K");
  EXPECT_EQ(wordsOf(changes, "visibility"), "atmosphere.visibility 8 km -> 6 km");
  EXPECT_EQ(wordsOf(changes, "material"), "none: no body has a material of one name");
  EXPECT_EQ(wordsOf(changes, "position"), "entities.jet.motion.0.position.0 0 m -> 1 m");
  EXPECT_EQ(wordsOf(changes, "accuracy"), "accuracy.asked 2 % -> 1 %");
}

}  // namespace
}  // namespace pitviper::test
