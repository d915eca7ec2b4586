// `bench --first` and `bench --guard` as a user runs them, on a scenario that takes a second.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScenario =
    "time: {rate: 10 Hz, frames: 3}\natmosphere: {extinction: 0.1 /km, temperature: 288 K}\n"
    "entities:\n  - {name: ball, shape: {model: sphere, radius: 1 m}, material: flat_black_paint, temperature: 300 K, position: [0 m, 300 m, 40 m]}\n"
    "cameras:\n  - {name: c, film: {width: 32, height: 32}, field_of_view: 1 deg, aperture: 5 cm, position: [0 m, 0 m, 40 m], look_at: ball, channels: [{name: "
    "mw, response: {band: [4 um, "
    "4.1 um]}}]}\n";

/// Cells of a CSV's lines by the names of its columns.
std::vector<std::map<std::string, std::string>> rowsOf(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::vector<std::string>> lines;
  for (std::string line; std::getline(in, line);) {
    lines.emplace_back(1);
    bool quoted = false;
    for (char c : line) {
      if (c == '"') quoted = !quoted;
      else if (c == ',' && !quoted) lines.back().emplace_back();
      else lines.back().back() += c;
    }
  }
  std::vector<std::map<std::string, std::string>> rows;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    rows.emplace_back();
    for (std::size_t column = 0; column < lines[0].size() && column < lines[k].size(); ++column) rows.back()[lines[0][column]] = lines[k][column];
  }
  return rows;
}

TEST(BenchFirst, StagesOfEveryState) {
  const TemporaryFolder folder;
  const std::string scenario = folder.put("s.yaml", kScenario);
  const Result r = pitviper("bench --first " + scenario + " --states second,temperature,visibility,accuracy --frames 7 --out " + folder.path().string());
  ASSERT_EQ(r.code, 0) << r.output;
  EXPECT_NE(r.output.find("temperature: entities.ball.temperature 300 K -> 310 K\n"), std::string::npos) << r.output;
  EXPECT_NE(r.output.find("accuracy: no accuracy is asked for; left out\n"), std::string::npos) << r.output;
  const auto rows = rowsOf(folder.path() / "first.csv");
  ASSERT_EQ(rows.size(), 5u);
  for (const auto& row : rows) {
    const bool measured = row.at("state") != "visibility" && row.at("state") != "accuracy";
    EXPECT_EQ(row.at("picture").empty(), !measured) << row.at("state");
    if (!measured) continue;
    double sum = 0.0;
    for (const char* stage : {"reading", "planning", "tables", "programs", "first_frame"}) {
      EXPECT_GE(std::stod(row.at(stage)), 0.0) << stage;
      sum += std::stod(row.at(stage));
    }
    EXPECT_LE(sum, std::stod(row.at("picture"))) << "stages are parts of the whole";
    EXPECT_GT(std::stod(row.at("programs_made")), 0.0);
    EXPECT_EQ(row.at("frames"), "7") << "from the first again where there are only three";
    EXPECT_LE(std::stod(row.at("frame_50")), std::stod(row.at("frame_99")));
    EXPECT_LE(std::stod(row.at("frame_99")), std::stod(row.at("frame_most")));
    EXPECT_GT(std::stod(row.at("memory")), 10.0);
  }
  EXPECT_EQ(rows[0].at("state"), "first");
  // A driver without a cache of its own has nothing to gain.
  EXPECT_GE(std::stod(rows[0].at("compiled")), std::stod(rows[1].at("compiled")));
}

TEST(BenchFirst, WhatCannotBeMeasuredIsSaid) {
  const TemporaryFolder folder;
  const Result blind = pitviper(
      "bench --first " + folder.put("s.yaml", "probes: [{name: p, position: [0 m, 0 m, 0 m], channels: [{name: a, response: {band: [4 um, 4.1 um]}}]}]\n"));
  EXPECT_EQ(blind.code, 2) << blind.output;
  EXPECT_NE(blind.output.find("s.yaml: the scenario has no camera, so there is no picture to wait for; expected"), std::string::npos) << blind.output;
  const Result wrong = pitviper("bench --first " + folder.put("t.yaml", "nonsense: 1\n"));
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.output.find("t.yaml:1:1: unknown key 'nonsense'"), std::string::npos) << wrong.output;
  EXPECT_EQ(pitviper("bench --first a.yaml --states thrid").output.find("--states thrid: there is no state 'thrid'"), 0u);
  EXPECT_EQ(pitviper("bench --once a.yaml --seconds -1").output.find("--seconds -1: not a time that frames may take"), 0u);
  EXPECT_EQ(pitviper("bench --first a.yaml --frames 1.5").code, 2);
}

TEST(BenchGuard, NamesWhatGrewAndFailsOnlyWhereAsked) {
  const TemporaryFolder folder;
  folder.put("s.yaml", kScenario);
  fs::create_directories(folder.path() / "code");
  folder.put("code/a.cpp", "int a;\nint b;\n");
  const std::string file = folder.put("guard.csv",
                                      "quick, code, , lines, 2, two\n"
                                      "quick, s.yaml, first, picture_work, 0.001, of a machine that is too quick\n"
                                      "quick, s.yaml, first, program_lines, 1000000, of a program that is too long\n"
                                      "quick, s.yaml, visibility, groups, 3, of air that is not there\n"
                                      "all, code, , lines, 1, not of the quick ones\n");
  EXPECT_EQ(pitviper("bench --guard " + file).code, 2) << "the same figure twice";
  std::string text;
  std::getline(std::ifstream(file), text, '\0');
  folder.put("guard.csv", text.substr(0, text.find("all,")));
  const Result r = pitviper("bench --guard " + file + " --quick");
  EXPECT_EQ(r.code, 0) << r.output;
  const bool isOnProcessor = r.output.find("no yardstick for its seconds") == std::string::npos;
  if (isOnProcessor) {
    EXPECT_NE(r.output.find("\ngrown: s.yaml, first, picture_work: "), std::string::npos) << r.output;
  }
  EXPECT_NE(r.output.find("better, write it down: s.yaml, first, program_lines: "), std::string::npos) << r.output;
  EXPECT_NE(r.output.find("not measured: s.yaml, visibility, groups: "), std::string::npos) << r.output;
  EXPECT_EQ(r.output.find("grown: code"), std::string::npos) << r.output;
  folder.put("guard.csv", "all, code, , lines, 1, there was one\n");
  EXPECT_EQ(pitviper("bench --guard " + file).code, 0);
  const Result strict = pitviper("bench --guard " + file + " --strict");
  EXPECT_EQ(strict.code, 1);
  EXPECT_NE(strict.output.find("grown: code, lines: 2, 1 in the file (+100 %): there was one"), std::string::npos) << strict.output;
  EXPECT_EQ(pitviper("bench --guard " + file + " --quick").code, 2) << "no figure of that set";
}

}  // namespace
}  // namespace pitviper::test
