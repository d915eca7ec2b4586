// Options of a command: read, refused and told by one table.
#include <gtest/gtest.h>

#include <set>

#include "scenarios/commands/commands.hpp"
#include "scenarios/sweep/sweep_command.hpp"

namespace pitviper::test {
namespace {

enum class Colour { Red, Green };

struct Wish {
  bool loud = false;
  int count = 7;
  double delay_s = 0.5, share = 0.5;
  std::optional<double> length_m;
  std::optional<Colour> colour;
  std::string file;
  std::vector<std::string> sets, days;
  Arguments words;
};

CommandLine tableOf(Wish& w) {
  return {{"toy", "A [B]"},
          "Does nothing.",
          {{"--loud", "", "with noise", into(w.loud)},
           {"--count", "N", "so often", number(w.count, {1, 9, "", false, "no count"})},
           {"--delay", "'T s'", "waits", number(w.delay_s, {0.1, 10.0, "s"})},
           {"--share", "X", "of all", number(w.share, {0.0, 1.0})},
           {"--length", "M", "of it", number(w.length_m, {1.0, 5.0, "m", true})},
           {"--colour", "NAME", "of it", oneOf(w.colour, {{"red", Colour::Red, "as blood"}, {"green", Colour::Green, "as grass"}})},
           {"--file", "FILE", "where", into(w.file), "--loud"},
           {"--set", "K=V...", "changes", into(w.sets)},
           {"--days", "A,B", "then", someOf(w.days, {"monday", "tuesday"}, "day"), "B"}},
          [&w](const Arguments& words) {
            w.words = words;
            return 5;
          },
          "And that is all."};
}

std::string refusal(const Arguments& arguments, const std::vector<CommandLine>& others = {}) {
  Wish w;
  try {
    perform(tableOf(w), arguments, others);
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(Options, GoWhereTheTableSays) {
  Wish w;
  EXPECT_EQ(perform(tableOf(w), {"a", "--loud", "--count=9", "--delay", "200 ms", "--share", "0.25", "--length", "3", "--colour", "green", "-5", "--file", "x",
                                 "--set", "a=1", "--set=b=2", "--days", "tuesday,monday"}),
            5);
  EXPECT_EQ(w.words, (Arguments{"a", "-5"}));
  EXPECT_TRUE(w.loud);
  EXPECT_EQ(w.count, 9);
  EXPECT_DOUBLE_EQ(w.delay_s, 0.2);
  EXPECT_DOUBLE_EQ(w.share, 0.25);
  EXPECT_DOUBLE_EQ(w.length_m.value(), 3.0);
  EXPECT_EQ(w.colour, Colour::Green);
  EXPECT_EQ(w.sets, (std::vector<std::string>{"a=1", "b=2"}));
  EXPECT_EQ(w.days, (std::vector<std::string>{"tuesday", "monday"}));
  EXPECT_EQ(perform(tableOf(w), {"a", "--length", "250 cm"}), 5);
  EXPECT_DOUBLE_EQ(w.length_m.value(), 2.5);
}

TEST(Options, AreRefusedInOneLineWithTheFix) {
  const std::vector<std::pair<Arguments, std::string>> wrong = {
      {{}, "pitviper toy: too few arguments; expected A [B]"},
      {{"a", "b", "c"}, "pitviper toy: too many arguments ('c')"},
      {{"a", "--cuont", "3"}, "pitviper toy: unknown option '--cuont'; expected an option of pitviper toy --help; fix: did you mean '--count'?"},
      {{"a", "--count"}, "pitviper toy: --count has no value"},
      {{"a", "--loud=yes"}, "pitviper toy: --loud takes no value; expected the flag alone; fix: remove '=yes'"},
      {{"a", "--loud", "--loud"}, "pitviper toy: --loud given twice"},
      {{"a", "--count", "10"}, "--count 10: no count; expected a whole number, 1 to 9; fix: write --count 7"},
      {{"a", "--count", "2.5"}, "--count 2.5: no count"},
      {{"a", "--count", "99999999999"}, "--count 99999999999: no count"},
      {{"a", "--delay", "2"}, "--delay 2: no such quantity, or out of range; expected a number with its unit, 0.1 s to 10 s; fix: write --delay '0.5 s'"},
      {{"a", "--delay", "2 m"}, "--delay 2 m: no such quantity"},
      {{"a", "--delay", "11 s"}, "--delay 11 s: no such quantity"},
      {{"a", "--share", "nan"}, "--share nan: no such quantity"},
      {{"a", "--length", "0.5"}, "--length 0.5: no such quantity, or out of range; expected a number, 1 m to 5 m; fix: write --length '1 m'"},
      {{"a", "--colour", "gren"}, "--colour gren: --colour has no 'gren'; expected one of red, green; fix: did you mean 'green'?"},
      {{"a", "--file", "x"}, "--file: it does nothing without --loud; expected '--loud' beside it; fix: add it, or remove --file"},
      {{"a", "b", "--days", "mondy"}, "--days mondy: there is no day 'mondy'; expected some of monday, tuesday, between commas; fix: did you mean 'monday'?"},
  };
  for (const auto& [arguments, says] : wrong) EXPECT_EQ(refusal(arguments).substr(0, says.size()), says);
  CommandLine other{{"toy --far", ""}, "", {{"--miles", "N", "", {}}}, {}};
  EXPECT_EQ(refusal({"a", "--miles", "3"}, {other}).substr(0, 87), "pitviper toy: --miles says nothing to pitviper toy; expected it with pitviper toy --far");
  EXPECT_NE(refusal({"a", "--mils", "3"}, {other}).find("unknown option '--mils'"), std::string::npos);
}

TEST(Options, AreToldWithTheirLimitsAndDefaults) {
  Wish w;
  const std::string help = helpOf({tableOf(w)});
  for (const char* part :
       {"pitviper toy A [B] [--loud] [--count N] [--delay 'T s']", "[--set K=V]...", "Does nothing.\n\n  --loud                with noise\n",
        "  --count N             so often (1 to 9; default 7)\n", "  --delay 'T s'         waits (0.1 s to 10 s; default 0.5 s)\n",
        "                        red: as blood\n", "  --set K=V             changes; repeatable\n", "then (monday, tuesday)", "\n\nAnd that is all.\n"})
    EXPECT_NE(help.find(part), std::string::npos) << part << "\n" << help;
}

// Every command of the program: one row for each name, nothing untold, no line that a terminal would break.
TEST(Options, OfEveryCommandAreWhole) {
  for (const CommandLine& c :
       {runCommand(),        checkCommand(),      planCommand(),     auditCommand(),         infoCommand(),          integrateCommand(),  streamCommand(),
        selfTestCommand(),   measureCommand(),    benchCommand(),    scenarioBenchCommand(), accuracyBenchCommand(), firstBenchCommand(), onceBenchCommand(),
        guardBenchCommand(), phongBenchCommand(), materialCommand(), atmosphereCommand(),    skyCommand(),           keysCommand({}),     sweepCommand()}) {
    std::set<std::string> names;
    for (const Option& o : c.options) {
      EXPECT_FALSE(o.help.empty()) << c.name << o.name;
      if (o.name.empty()) continue;
      EXPECT_TRUE(o.name.starts_with("--") && o.to.take) << c.name << " " << o.name;
      EXPECT_TRUE(names.insert(o.name).second) << c.name << " " << o.name;
    }
    for (const Option& o : c.options)
      if (o.needs.starts_with("--")) {
        EXPECT_EQ(names.count(o.needs), 1u) << c.name << " " << o.name;
      }
    std::istringstream help(helpOf({c}));
    for (std::string line; std::getline(help, line);) EXPECT_LE(line.size(), 120u) << line;
  }
}

}  // namespace
}  // namespace pitviper::test
