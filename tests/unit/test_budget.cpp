// The accounts of the accuracy: what adds up in a pixel leaves enough for wavelengths, and nobody spends it elsewhere.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

#include "scenarios/commands/plan_report.hpp"
#include "sim/plan/budget.hpp"
#include "tests/support/figures.hpp"

namespace pitviper {
namespace {

using test::bound;

double sumOf(Adds adds, std::string_view without = "") {
  double sum = 0.0;
  for (const Account& a : budget::kAccounts)
    if (a.adds == adds && a.name != without) sum += adds == Adds::AsSquares ? a.share * a.share : a.share;
  return adds == Adds::AsSquares ? std::sqrt(sum) : sum;
}

TEST(Budget, EachAccountHasANameAShareAndAReason) {
  std::set<std::string_view> names;
  for (const Account& a : budget::kAccounts) {
    EXPECT_TRUE(names.insert(a.name).second) << a.name;
    EXPECT_GT(a.share, 0.0) << a.name;
    EXPECT_GT(a.why.size(), 10u) << a.name;
    EXPECT_TRUE(a.adds == Adds::Apart || a.share <= 1.0) << a.name;
  }
}

// Wavelengths have the rest. Fields, light from all around and tables may each take what scenes need that have much of one of them: a scene that fills all
// three asks for more than there is, and its plan says so (below).
TEST(Budget, WhatAddsUpInAPixelLeavesARestForWavelengths) {
  for (const Account& most : {budget::kFields, budget::kSurroundings, budget::kTables})
    bound("accounts of a pixel without " + std::string(most.name), sumOf(Adds::InFull, most.name), 1.0, "what is asked; wavelengths have the rest");
  EXPECT_GT(sumOf(Adds::InFull), 1.0) << "no account needs the word of the plan any more: say so here and in budget.hpp";
}

// Standard deviations of what has nothing to do with each other.
TEST(Budget, TheIntensityOfABodyIsHeldAtTwoSigma) {
  bound("outlines and bright parts, 2 sigma", 2.0 * sumOf(Adds::AsSquares), 1.0, "the accuracy of a body's intensity");
}

TEST(Budget, WhatLiesWithinAnAccountFitsIntoIt) {
  bound("tables: three ways, what views share and the sun's steps", 4.0 * budget::kTableSteps.share + budget::kSunSteps.share, budget::kTables.share, "tables");
  bound("of fields: what is not drawn", budget::kFaintFields.share, budget::kFields.share, "fields");
  EXPECT_LT(budget::kFitted.share, budget::kUnseen.share) << "what is fitted to is met closer than what is not";
  EXPECT_LT(budget::kLearnt.share, budget::kHeld.share) << "what is learnt from is less than what is refused";
}

std::string textOf(double accuracy, const PredictedParts& parts) {
  Plan plan;
  plan.accuracy = accuracy;
  plan.slotCount = 1;
  plan.slotOfOutput = {0};
  plan.weight = {{}};
  plan.fineCount = {100};
  plan.parts = {parts};
  plan.predictedError = {parts.sum()};
  plan.surroundingsLoss = {parts.surroundings};
  std::vector<ChannelOutput> outputs(1);
  outputs.front().channel = "mw";
  return planText({"camera a", outputs, plan, 0.0, 0.0, 0.0, 0.0, false, false, "", nullptr});
}

std::string rowOf(const std::string& text, std::string_view name) {
  const size_t at = text.find("\n  " + std::string(name));
  return at == std::string::npos ? "" : text.substr(at + 3, text.find('\n', at + 1) - at - 3);
}

TEST(Budget, APlanTellsEachAccountBesideWhatItLost) {
  for (const double accuracy : {0.005, 0.01, 0.05, 0.2}) {
    const PredictedParts parts{0.31 * accuracy, 0.1 * accuracy, 0.032 * accuracy, 6e-5, 0.2 * accuracy, 0.004 * accuracy, budget::kFields.of(accuracy),
                               0.4 * accuracy};
    const std::string text = textOf(accuracy, parts);
    const auto has = [&](std::string_view name, const std::string& most, double lost) {
      char own[64];
      std::snprintf(own, sizeof own, 100.0 * lost < 0.1 ? "%.3f" : 100.0 * lost < 10.0 ? "%.2f" : "%.0f", 100.0 * lost);
      const std::string row = rowOf(text, name);
      EXPECT_NE(row.find(most), std::string::npos) << most << " in: " << row << "\n" << text;
      EXPECT_TRUE(row.ends_with(own)) << own << " in: " << row;
    };
    char tables[32];
    std::snprintf(tables, sizeof tables, 0.3 * accuracy < 0.001 ? " %.3f " : " %.2f ", 30.0 * accuracy);
    has("wavelengths", "the rest", parts.wavelengths);
    has("tables", tables, parts.tables);
    has("terms left out", " each ", parts.dropped);
    has("light from all around", "", parts.surroundings);
    has("light scattered again", "", parts.streams);
    has("steps through plumes and clouds", "", parts.fields);
    has("precision", "", parts.precision);
    EXPECT_EQ(text.find("MORE THAN ASKED FOR"), std::string::npos) << text;
  }
  // All accounts at their most leave nothing.
  const double accuracy = 0.01;
  const PredictedParts most{0.0,
                            budget::kTables.of(accuracy),
                            budget::kTerms.of(accuracy),
                            6e-5,
                            budget::kSurroundings.of(accuracy),
                            budget::kStreams.of(accuracy),
                            budget::kFields.of(accuracy)};
  EXPECT_NE(textOf(accuracy, most).find("MORE THAN ASKED FOR"), std::string::npos);
}

/// Where a line takes a part of the accuracy by a number of its own.
bool isSpentIn(const std::string& line) {
  static const std::regex by(R"((\b\d[\d.e-]*|\bk[A-Z]\w*) *\* *(\w+(\.|->))*(accuracy|asked)_?\b(?![.(]))");
  static const std::regex told(R"(100\.0 \* (\w+(\.|->))*(accuracy|asked)_?\b)");  // in per cent, to people
  const std::string code = line.substr(0, line.find("//"));
  return std::regex_search(std::regex_replace(code, told, ""), by);
}

TEST(Budget, NobodySpendsTheAccuracyElsewhere) {
  EXPECT_TRUE(isSpentIn("  const double most = kMine * plan_.accuracy;"));
  EXPECT_TRUE(isSpentIn("  if (lost > 0.25 * accuracy_) return;"));
  EXPECT_TRUE(isSpentIn("  lost(1e-3*asked)"));
  EXPECT_FALSE(isSpentIn("  // a tenth, 0.1 * accuracy"));
  EXPECT_FALSE(isSpentIn("  print(\"%g %%\", 100.0 * s.accuracy);"));
  EXPECT_FALSE(isSpentIn("  const double most = budget::kTables.of(plan.accuracy);"));
  const std::filesystem::path root = PITVIPER_SOURCE_DIR;
  int files = 0;
  for (const char* top : {"sim", "materials", "atmosphere", "sensors", "scenarios"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / top)) {
      const std::string ext = entry.path().extension().string();
      if (ext != ".cpp" && ext != ".hpp") continue;
      std::ifstream in(entry.path());
      int number = 0;
      for (std::string line; std::getline(in, line);)
        if (++number; isSpentIn(line)) ADD_FAILURE() << std::filesystem::relative(entry.path(), root).string() << ":" << number << ": " << line;
      ++files;
    }
  EXPECT_GT(files, 500);
}

}  // namespace
}  // namespace pitviper
