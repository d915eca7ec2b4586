// Scenarios put together from files, with parameters, expressions and repeated entries: what comes out, and where messages point to.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "scenarios/reader/expand.hpp"
#include "scenarios/reader/expression.hpp"
#include "scenarios/reader/repeat.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/parameters/table.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

struct Expand : testing::Test {
  TemporaryFolder folder;
  Libraries libraries;
  std::vector<fs::path> roots;

  void put(const std::string& name, const std::string& content) const {
    fs::create_directories((folder.path() / name).parent_path());
    folder.put(name, content);
  }
  ExpandedScenario expanded(const std::string& scenario, const std::vector<std::string>& overrides = {}, const std::string& below = "") const {
    return expandScenario(scenario, "own.yaml", folder.path() / below, overrides, libraries, roots);
  }
  Value tree(const std::string& scenario, const std::vector<std::string>& overrides = {}) const { return expanded(scenario, overrides).tree; }
  /// The message, the folder's name left out of it.
  std::string refusal(const std::string& scenario, const std::vector<std::string>& overrides = {}, const std::string& below = "") const {
    try {
      expanded(scenario, overrides, below);
    } catch (const UserError& e) {
      std::string message = e.what();
      const std::string own = folder.path().string() + "/";
      for (size_t at = message.find(own); at != std::string::npos; at = message.find(own)) message.erase(at, own.size());
      return message;
    }
    return "nothing refused";
  }
};

/// As flow style.
std::string written(const Value& v) {
  std::string t;
  switch (v.kind) {
    case Value::Kind::Null:
      return "~";
    case Value::Kind::Scalar:
      return v.text;
    case Value::Kind::List:
      for (const Value& i : v.items) t += (t.empty() ? "" : ", ") + written(i);
      return "[" + t + "]";
    case Value::Kind::Map:
      for (const auto& [key, i] : v.entries) t += (t.empty() ? "" : ", ") + key + ": " + written(i);
      return "{" + t + "}";
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

#define EXPECT_HAS(message, part) EXPECT_TRUE(has(message, part)) << (message)

std::string worth(const std::string& expression) {
  return evaluate(expression, {"a.yaml", 1, 1, -1}, [](std::string_view name) -> WrittenQuantity {
    if (name == "speed") return {250.0, "m/s"};
    if (name == "n") return {3.0, ""};
    if (name == "warm") return {27.0, "degC"};
    throw UserError({"a.yaml", 1, 1, -1}, "no such");
  });
}

std::string fault(const std::string& expression) {
  try {
    return worth(expression);
  } catch (const UserError& e) {
    return e.what();
  }
}

// Expected: exactly these texts; the numbers are chosen so that arithmetic in doubles is exact.
TEST(Expression, IsANumberWithUnit) {
  EXPECT_EQ(worth("1 + 2 * 3"), "7");
  EXPECT_EQ(worth("(1 + 2) * -3"), "-9");
  EXPECT_EQ(worth("8 / 2 / 2"), "2");
  EXPECT_EQ(worth("5 - 3 - 1"), "1");
  EXPECT_EQ(worth("$speed * 4 s"), "1000 m");
  EXPECT_EQ(worth("${speed}*4 s - 300 m"), "700 m");
  EXPECT_EQ(worth("2 km + 500 m"), "2.5 km");  // in the first one's unit
  EXPECT_EQ(worth("500 m + 2 km"), "2500 m");
  EXPECT_EQ(worth("3.5 um * 2"), "7 um");
  EXPECT_EQ(worth("1 m / 4 s"), "0.25 m s-1");
  EXPECT_EQ(worth("6 m / 2 m"), "3");
  EXPECT_EQ(worth("10 W/(m2 sr um) * $n"), "30 W/(m2 sr um)");
  EXPECT_EQ(worth("10 m-2 m"), "8 m");  // no exponent without '^'
  EXPECT_EQ(worth("4 m2 * 2"), "8 m2");
  EXPECT_EQ(worth("0.5 /km * 2"), "1 /km");
  EXPECT_EQ(worth("1 /km * 5 km"), "5");
  EXPECT_EQ(worth("max(1 m, 20 cm, 2 km)"), "2 km");
  EXPECT_EQ(worth("min(5 min, 2 s)"), "2 s");  // function and minutes
  EXPECT_EQ(worth("abs(-3 s)"), "3 s");
  EXPECT_EQ(worth("floor(-1.5)"), "-2");
  EXPECT_EQ(worth("mod(7, 3)"), "1");
  EXPECT_EQ(worth("mod(-90 deg, 360 deg)"), "270 deg");
  EXPECT_EQ(worth("sqrt(9 m2)"), "3 m");
  EXPECT_EQ(worth("cos(0 deg) * 2 m"), "2 m");
  EXPECT_EQ(worth("$warm + 5 K"), "305.15 K");
  EXPECT_EQ(worth("$warm - 7 degC"), "20 K");  // a difference
  EXPECT_EQ(worth("100000 * 10"), "1000000");  // whole numbers stay readable as such
  EXPECT_EQ(worth("$n"), "3");
}

// Expected: within two units in the last place of sine and root, whose arguments are rounded.
TEST(Expression, Functions) {
  EXPECT_NEAR(std::stod(worth("sin(30 deg)")), 0.5, 2e-16);
  EXPECT_NEAR(std::stod(worth("tan(45 deg)")), 1.0, 4e-16);
  EXPECT_NEAR(std::stod(worth("sqrt(2)")), std::sqrt(2.0), 0.0);
  EXPECT_NEAR(std::stod(worth("sin(pi / 6 * 1 rad)")), 0.5, 2e-16);
  EXPECT_NEAR(std::stod(worth("0.1 + 0.2")), 0.1 + 0.2, 0.0);  // as many digits as bring the double back
}

TEST(Expression, MistakesAreTold) {
  EXPECT_EQ(fault("2 m + 3 s"), "a.yaml:1:1: '2 m' and '3 s' cannot be added; expected two values of one kind, as lengths or times; fix: correct the units");
  EXPECT_HAS(fault("2 m - 3"), "cannot be subtracted");
  EXPECT_HAS(fault("max(1 m, 2 K)"), "cannot be compared");
  EXPECT_HAS(fault("sin(30)"), "expected an angle");
  EXPECT_HAS(fault("sqrt(2 m)"), "a unit that is a square");
  EXPECT_HAS(fault("sqrt(-1)"), "square root of '-1'");
  EXPECT_HAS(fault("floor(2 m)"), "floor of '2 m'");
  EXPECT_HAS(fault("1 / 0"), "divided by 0");
  EXPECT_HAS(fault("1 / (2 s - 2 s)"), "divided by 0");
  EXPECT_HAS(fault("mod(1, 0)"), "mod of '1' by 0");
  EXPECT_HAS(fault("1e300 * 1e300"), "not finite");
  EXPECT_HAS(fault("$warm + 3 degC"), "write the difference in K");
  EXPECT_HAS(fault("speed * 2"), "'$speed' for a parameter");
  EXPECT_HAS(fault("mix(1, 2)"), "did you mean 'min'?");
  EXPECT_HAS(fault("2 furlong"), "'furlong' where it cannot be");
  EXPECT_HAS(fault("(1"), "ends too early");
  EXPECT_HAS(fault(""), "ends too early");
  EXPECT_HAS(fault("1 2"), "where it cannot be");
  EXPECT_HAS(fault("mod(1)"), "mod of 1 values");
  EXPECT_HAS(fault("1 m2 * 1 m4 * 1 m4"), "to the power of 10");
  EXPECT_HAS(fault(std::string(100000, '(') + "1"), "nested deeper than 64");
  EXPECT_HAS(fault(std::string(100000, '-') + "1"), "1");
}

TEST_F(Expand, LeavesOthersAsTheyAre) {
  EXPECT_EQ(written(tree("a: {b: [1, x, ~]}\nc: \"\"\n")), "{a: {b: [1, x, ~]}, c: }");
  EXPECT_EQ(expanded("a: 1\n").identity, "a: 1\n");
  EXPECT_EQ(written(tree("[1, 2]\n")), "[1, 2]");
}

TEST_F(Expand, ParametersStandForTrees) {
  EXPECT_EQ(written(tree("parameters: {v: 250 m/s, p: [1 m, $h], h: 3 m, m: {a: ~}}\na: $v\nb: ${p}\nc: \"at $v, ${h}s; 5 $$\"\nd: {e: [$m]}\n")),
            "{a: 250 m/s, b: [1 m, 3 m], c: at 250 m/s, 3 ms; 5 $, d: {e: [{a: ~}]}}");
  EXPECT_EQ(written(tree("parameters: {v: 250 m/s, t: \"= 1 km / $v\"}\na: = $t * 2\nb: [\"= max($t, 5 s)\", = $v]\n")), "{a: 8 s, b: [5 s, 250 m/s]}");
  EXPECT_EQ(written(tree("parameters: {v: 1 m}\na: $v\n", {"parameters.v=2 m", "a=$v"})), "{a: $v}");  // others are set at the end, as they are
  EXPECT_EQ(written(tree("parameters: {v: 1 m}\na: $v\n", {"parameters.v=2 m"})), "{a: 2 m}");
  EXPECT_EQ(written(tree("parameters: {v: {w: 1}}\na: $v\n", {"parameters.v.w=2"})), "{a: {w: 2}}");
}

TEST_F(Expand, ValuesKnowWhereTheyWereWritten) {
  const Value t = tree("parameters:\n  v: 250 m/s\na: $v\nb: = 2 * $v\n");
  EXPECT_EQ(t.find("a")->where.text(), "own.yaml:2:6");
  EXPECT_EQ(t.find("b")->where.text(), "own.yaml:4:4");
  put("part.yaml", "c: 1\nlist:\n  - {name: x}\n");
  const Value u = tree("include: part.yaml\nlist: [{name: y}]\n");
  EXPECT_EQ(u.find("c")->where.text(), (folder.path() / "part.yaml").string() + ":1:4");
  EXPECT_EQ(u.find("list")->items[0].find("name")->where.line, 3);
  EXPECT_EQ(u.find("list")->items[1].where.text(), "own.yaml:2:8");
}

TEST_F(Expand, ParametersThatCannotBe) {
  EXPECT_EQ(refusal("parameters: {speed: 1, height: 2}\na: $sped\nb: $speed\nc: $height\n"),
            "own.yaml:2:4: there is no parameter 'sped'; expected one of $speed, $height; fix: write it under 'parameters:', or '$$' for a dollar");
  EXPECT_HAS(refusal("a: $x\n"), "own.yaml:1:4: there is no parameter 'x'; expected none: there are none");
  EXPECT_HAS(refusal("a: b\nc: [x, \"= $nothing + 1\"]\n"), "own.yaml:2:8: there is no parameter 'nothing'");
  EXPECT_HAS(refusal("parameters:\n  used: 1\n  spare: $used\na: 1\n"), "nothing uses the parameter 'spare'");
  EXPECT_HAS(refusal("parameters:\n  used: 1\n  spare: $used\na: $used\n"), "own.yaml:3:3: nothing uses the parameter 'spare'");
  EXPECT_HAS(refusal("parameters: {a: $b, b: [$c], c: {x: $a}}\nq: $b\n"), "parameters that hold themselves: $b -> $c -> $a -> $b");
  EXPECT_HAS(refusal("parameters: {a: \"= $a + 1\"}\nq: $a\n"), "own.yaml:1:17: parameters that hold themselves: $a -> $a");
  EXPECT_HAS(refusal("parameters: {a: [1, 2]}\nq: x_$a\n"), "parameter 'a' is a list (own.yaml:1:17) and stands within a text");
  EXPECT_HAS(refusal("parameters: {a: red}\nq: = $a * 2\n"), "own.yaml:2:4: parameter 'a' is 'red' (own.yaml:1:17) and stands in an expression");
  EXPECT_HAS(refusal("parameters: {2a: red}\n"), "own.yaml:1:14: a parameter cannot be called '2a'");
  EXPECT_HAS(refusal("parameters: [1]\na: $b\n"), "parameters is a list");
  EXPECT_HAS(refusal("parameters: {a: 1, a: 2}\nb: $a\n"), "own.yaml:1:20: duplicate key 'a' in parameters");
  EXPECT_HAS(refusal("a: costs 5 $\n"), "own.yaml:1:4: a dollar without a name");
  EXPECT_HAS(refusal("a: ${\n"), "a dollar without a name");
  EXPECT_HAS(refusal("parameters: {v: 1}\na: $v\n", {"parameters.w=2"}), "--set parameters.w=2: there is no parameter 'w'; expected one of v");
  EXPECT_HAS(refusal("a: 1\n", {"parameters.w=2"}), "there is no parameter 'w'; expected none");
  EXPECT_HAS(refusal("parameters: {v: 1}\na: $v\n", {"parameters={v: 2}"}), "not one parameter");
}

TEST_F(Expand, IncludedKeysLieUnderOwnOnes) {
  put("a.yaml", "air: {model: layered, visibility: 5 km}\nlist: [{name: a}]\nsinks: [x]\nseed: 2\nplace: {position: [1, 2, 3]}\n");
  put("b.yaml", "air: {visibility: 8 km, base: 0 m}\nlist: [{name: b}]\nseed: 3\n");
  EXPECT_EQ(
      written(tree("include: [a.yaml, b.yaml]\nair: {base: 9 m}\nlist: [{name: own}]\nsinks: [y]\nplace: {position: [4, 5, 6]}\n")),
      "{air: {base: 9 m, visibility: 8 km, model: layered}, list: [{name: a}, {name: b}, {name: own}], sinks: [y], place: {position: [4, 5, 6]}, seed: 3}");
  EXPECT_EQ(written(tree("include: a.yaml\nair: none\n")), "{air: none, list: [{name: a}], sinks: [x], seed: 2, place: {position: [1, 2, 3]}}");
  EXPECT_HAS(refusal("include: [a.yaml, b.yaml]\nlist:\n  - {name: c}\n  - {name: b}\n"),
             "own.yaml:4:12: 'b' in list stands at b.yaml:2:15 too, which is included");
  EXPECT_HAS(refusal("include: a.yaml\nlist: none\n"), "own.yaml:2:7: 'list' is a single value, and a list at a.yaml:2:7");
  EXPECT_HAS(refusal("include: a.yaml\ninclude: b.yaml\n"), "own.yaml:2:1: duplicate key 'include'");
  EXPECT_HAS(refusal("include: {a: b}\n"), "own.yaml:1:10: include is a map of keys");
  EXPECT_HAS(refusal("include: none.yaml\n"), "own.yaml:1:10: cannot read the file");
  put("list.yaml", "- {name: z}\n");
  EXPECT_HAS(refusal("include: list.yaml\n"), "fix: include it as an entry of a list");
  EXPECT_HAS(refusal("a: 1\n", {"include=a.yaml"}), "what a scenario includes cannot be set from outside");
}

TEST_F(Expand, ParametersOfLayersAreOne) {
  put("base.yaml", "parameters: {speed: 1 m/s, far: {x: 1, y: 2}, spare: 1}\na: $speed\nb: $far\n");
  for (const char* word : {"include", "extends"}) {
    EXPECT_EQ(written(tree(std::string(word) + ": base.yaml\n")), "{a: 1 m/s, b: {x: 1, y: 2}}");
    EXPECT_EQ(written(tree(std::string(word) + ": base.yaml\nparameters: {speed: 3 m/s, far: {x: 5}}\n")), "{a: 3 m/s, b: {x: 5}}");
    EXPECT_EQ(written(tree(std::string(word) + ": base.yaml\n", {"parameters.speed=7 m/s"})), "{a: 7 m/s, b: {x: 1, y: 2}}");
    EXPECT_HAS(refusal(std::string(word) + ": base.yaml\n", {"parameters.spare=2"}), "nothing uses the parameter 'spare'");
  }
}

TEST_F(Expand, ExtendsFurther) {
  put("a/base.yaml", "extends: deeper.yaml\ninclude: part.yaml\nx: {p: 1}\nlist: [1]\n");
  put("a/deeper.yaml", "x: {q: 2}\ny: 3\nlist: [2]\n");
  put("a/part.yaml", "x: {r: 4}\nlist: [3]\nz: {file: m.obj}\n");
  // Whole keys of what is extended; those included put together with those of the file that includes them. Files are found from their own folder.
  EXPECT_EQ(written(tree("extends: a/base.yaml\nlist: [0]\n")), "{list: [0], x: {p: 1, r: 4}, z: {file: a/m.obj}, y: 3}");
  put("own/x.txt", "");
  EXPECT_EQ(written(expanded("extends: ../a/base.yaml\n", {}, "own").tree), "{x: {p: 1, r: 4}, list: [3, 1], z: {file: ../a/m.obj}, y: 3}");
}

TEST_F(Expand, FilesAreThoseOfTheFileThatNamesThem) {
  put("parts/tank.yaml", "parameters: {mesh: tank.obj, paint: {file: paint.csv}}\nshape: {file: $mesh}\npaint: $paint\nother: {table: sub/$which.csv}\n");
  put("parts/top.yaml", "sinks: [{sink: video, file: film.mp4}]\nair: {tape7: one.tp7}\n");
  EXPECT_EQ(written(tree("include: parts/top.yaml\nlist:\n  - {include: parts/tank.yaml, with: {which: a, mesh: own.obj}}\n  - {include: parts/tank.yaml, "
                         "with: {which: b}}\n")),
            "{list: [{shape: {file: own.obj}, paint: {file: parts/paint.csv}, other: {table: parts/sub/a.csv}}, "
            "{shape: {file: parts/tank.obj}, paint: {file: parts/paint.csv}, other: {table: parts/sub/b.csv}}], "
            "sinks: [{sink: video, file: film.mp4}], air: {tape7: parts/one.tp7}}");
}

TEST_F(Expand, FilesLieWhereTheyMay) {
  put("own/sub/part.yaml", "a: 1\n");
  put("elsewhere/part.yaml", "b: 2\nlist: [{file: x.csv}]\n");
  put("elsewhere/deep/other.yaml", "include: ../part.yaml\n");
  put("library/thing.yaml", "c: 3\n");
  EXPECT_EQ(written(expanded("include: sub/part.yaml\n", {}, "own").tree), "{a: 1}");
  const std::string outside = refusal("include: ../elsewhere/part.yaml\n", {}, "own");
  EXPECT_HAS(outside, "own.yaml:1:10: '../elsewhere/part.yaml' is not a file that a scenario may include");
  EXPECT_HAS(outside, "the folder of the scenario");
  EXPECT_HAS(outside, "allow its folder by --root FOLDER");
  EXPECT_HAS(refusal("include: /etc/passwd\n", {}, "own"), "is not a file that a scenario may include");
  EXPECT_HAS(refusal("include: " + (folder.path() / "elsewhere/part.yaml").string() + "\n", {}, "own"), "is not a file that a scenario may include");
  fs::create_directory_symlink(folder.path() / "elsewhere", folder.path() / "own/link");
  EXPECT_HAS(refusal("include: link/part.yaml\n", {}, "own"), "is not a file that a scenario may include");
  fs::create_symlink(folder.path() / "elsewhere/part.yaml", folder.path() / "own/link.yaml");
  EXPECT_HAS(refusal("include: link.yaml\n", {}, "own"), "is not a file that a scenario may include");
  EXPECT_HAS(refusal("list:\n  - include: link.yaml\n", {}, "own"), "own.yaml:2:14: 'link.yaml' is not a file that a scenario may include");
  roots = {folder.path() / "elsewhere"};
  EXPECT_HAS(refusal("include: ../library/thing.yaml\n", {}, "own"), "elsewhere' (--root)");
  EXPECT_EQ(written(expanded("include: link.yaml\n", {}, "own").tree), "{b: 2, list: [{file: x.csv}]}");  // by its words it lies beside the scenario
  const std::string moved = "{b: 2, list: [{file: " + (fs::path("../elsewhere") / "x.csv").string() + "}]}";
  EXPECT_EQ(written(expanded("include: ../elsewhere/part.yaml\n", {}, "own").tree), moved);
  EXPECT_EQ(written(expanded("include: part.yaml\n", {}, "own").tree), "{b: 2, list: [{file: ../elsewhere/x.csv}]}");  // found in the root
  EXPECT_EQ(written(expanded("include: deep/other.yaml\n", {}, "own").tree), "{b: 2, list: [{file: ../elsewhere/deep/../x.csv}]}");
  EXPECT_HAS(refusal("include: ../library/thing.yaml\n", {}, "own"), "is not a file");
  libraries.sensors = folder.path() / "library";
  EXPECT_EQ(written(expanded("include: thing.yaml\n", {}, "own").tree), "{c: 3}");
  roots = {folder.path() / "nowhere"};
  EXPECT_HAS(refusal("a: 1\n"), "nowhere: not a folder");
}

TEST_F(Expand, LoopsOfFilesAreNamed) {
  put("own.yaml", "include: a.yaml\n");
  put("a.yaml", "include: b.yaml\n");
  put("b.yaml", "x: 1\ninclude: a.yaml\n");
  EXPECT_HAS(refusal("include: a.yaml\n"), "b.yaml:2:10: files that include each other without end: a.yaml -> b.yaml -> a.yaml");
  put("self.yaml", "include: own.yaml\n");
  EXPECT_HAS(refusal("extends: self.yaml\n"), "self.yaml:1:10: files that include each other without end: own.yaml -> self.yaml -> own.yaml");
  put("list.yaml", "- {name: a}\n- include: list.yaml\n");
  EXPECT_HAS(refusal("list: [{include: list.yaml}]\n"), "list.yaml:2:12: files that include each other without end: list.yaml -> list.yaml");
  for (int k = 0; k < 20; ++k) put("d" + std::to_string(k) + ".yaml", "include: d" + std::to_string(k + 1) + ".yaml\n");
  put("d20.yaml", "x: 1\n");
  EXPECT_EQ(written(tree("include: d5.yaml\n")), "{x: 1}");  // sixteen
  EXPECT_HAS(refusal("include: d4.yaml\n"), "more than 16 deep");
}

TEST_F(Expand, EntriesFromFiles) {
  put("one.yaml", "parameters: {n: 0, colour: grey}\nname: one_$n\nmaterial: $colour\n");
  put("many.yaml", "- {name: a_$n}\n- {name: b, repeat: {count: $n}}\n- text\n");
  EXPECT_EQ(written(tree("parameters: {k: 5}\nlist:\n  - include: one.yaml\n  - {name: x}\n  - {include: one.yaml, with: {n: $k, colour: {rgb: [$k]}}}\n")),
            "{list: [{name: one_0, material: grey}, {name: x}, {name: one_5, material: {rgb: [5]}}]}");
  EXPECT_EQ(written(tree("list: [{include: many.yaml, with: {n: 2}}]\n")), "{list: [{name: a_2}, {name: b_0}, {name: b_1}, text]}");
  EXPECT_EQ(written(tree("parameters: {w: {n: 7}, which: one}\nlist: [{include: \"${which}.yaml\", with: $w}]\n")), "{list: [{name: one_7, material: grey}]}");
  EXPECT_HAS(refusal("list: [{include: many.yaml}]\n"), "many.yaml:1:10: there is no parameter 'n'");
  EXPECT_HAS(refusal("list: [{include: many.yaml}]\n"), "give it 'with: {n: ...}' where the file is included");
  EXPECT_HAS(refusal("parameters: {n: 1}\nb: $n\nlist: [{include: many.yaml}]\n"), "there is no parameter 'n'");  // not the scenario's
  EXPECT_HAS(refusal("list: [{include: one.yaml, with: {n: 1, color: red}}]\n"),
             "own.yaml:1:41: 'one.yaml' has no parameter 'color' and does not use $color; expected one of colour, n");
  EXPECT_HAS(refusal("list: [{include: one.yaml, position: 3}]\n"), "own.yaml:1:28: an entry that is included has the key 'position' besides");
  EXPECT_HAS(refusal("list: [{include: [one.yaml]}]\n"), "include is a list");
  put("text.yaml", "hello\n");
  EXPECT_HAS(refusal("list: [{include: text.yaml}]\n"), "'text.yaml' holds a single value");
  put("kind.yaml", "include: one.yaml\nmaterial: red\nposition: [1, 2]\nparameters: {n: 4}\n");
  EXPECT_EQ(written(tree("list: [{include: kind.yaml}]\n")), "{list: [{material: red, position: [1, 2], name: one_4}]}");
}

TEST_F(Expand, RepeatedEntries) {
  EXPECT_EQ(written(tree("list:\n  - {name: m, x: $i, repeat: {count: 3}}\n  - {name: end}\n")),
            "{list: [{name: m_0, x: 0}, {name: m_1, x: 1}, {name: m_2, x: 2}, {name: end}]}");
  EXPECT_EQ(written(tree("parameters: {n: 2}\nlist: [{name: \"m_${k}_x\", to: a_$k, repeat: {count: \"= $n * 1\", as: k}}]\n")),
            "{list: [{name: m_0_x, to: a_0}, {name: m_1_x, to: a_1}]}");
  EXPECT_EQ(written(tree("list: [{name: m, repeat: {count: 0}}]\n")), "{list: []}");
  EXPECT_EQ(written(tree("list: [{name: m, repeat: {count: 1}}]\n")), "{list: [{name: m_0}]}");
  EXPECT_EQ(written(tree("list:\n  - repeat: {count: 3, every: {position: [10 m, 0 m, -1 cm], motion: {time: 0.3 s}, t: 5 degC, v: \"1, 0, 0 m\"}}\n    "
                         "position: [1 km, 0 m, 5 m]\n"
                         "    motion: [{time: 0 s}, {time: 2 s}]\n    t: 27 degC\n    v: 1, 2, 3 m\n")),
            "{list: [{position: [1 km, 0 m, 5 m], motion: [{time: 0 s}, {time: 2 s}], t: 27 degC, v: 1, 2, 3 m}, "
            "{position: [1.01 km, 0 m, 4.99 m], motion: [{time: 0.3 s}, {time: 2.3 s}], t: 32 degC, v: [2 m, 2 m, 3 m]}, "
            "{position: [1.02 km, 0 m, 4.98 m], motion: [{time: 0.6 s}, {time: 2.6 s}], t: 37 degC, v: [3 m, 2 m, 3 m]}]}");
  // Within each other: names by both numbers; a name by its own number alone gets the other's.
  EXPECT_EQ(written(tree("list: [{name: p, repeat: {count: 2}, parts: [{name: q, at: $i$j, repeat: {count: 2, as: j}}]}]\n")),
            "{list: [{name: p_0, parts: [{name: q_0, at: 00}, {name: q_1, at: 01}]}, {name: p_1, parts: [{name: q_0, at: 10}, {name: q_1, at: 11}]}]}");
  put("one.yaml", "parameters: {n: 0}\nname: one_$n\nx: \"= $n * 2 m\"\n");
  EXPECT_EQ(written(tree("list: [{include: one.yaml, with: {n: $i}, repeat: {count: 2, every: {x: 1 m}}}]\n")),
            "{list: [{name: one_0, x: 0 m}, {name: one_1, x: 3 m}]}");
  EXPECT_EQ(written(tree("list: [{include: one.yaml, repeat: {count: 2}}]\n")), "{list: [{name: one_0_0, x: 0 m}, {name: one_0_1, x: 0 m}]}");
}

TEST_F(Expand, RepeatsThatCannotBe) {
  EXPECT_HAS(refusal("list: [{repeat: {count: 4097}}]\n"), "own.yaml:1:25: count is out of range (4097); expected 0 to 4096");
  EXPECT_HAS(refusal("list: [{repeat: {cout: 2}}]\n"), "did you mean 'count'?");
  EXPECT_HAS(refusal("list: [{repeat: 3}]\n"), "repeat is a single value");
  EXPECT_HAS(refusal("list: [{repeat: {count: 2, as: 3}}]\n"), "a parameter cannot be called '3'");
  EXPECT_HAS(refusal("parameters: {i: 1}\nb: $i\nlist: [{repeat: {count: 2}}]\n"), "'i' is the name of a parameter or of a repeated entry");
  EXPECT_HAS(refusal("list: [{repeat: {count: 2}, x: [{repeat: {count: 2}}]}]\n"), "'i' is the name of a parameter or of a repeated entry");
  EXPECT_HAS(refusal("list: [{x: 1, repeat: {count: 2, every: {y: 1}}}]\n"),
             "own.yaml:1:42: 'every' adds to 'y', which the entry at own.yaml:1:8 does not have");
  EXPECT_HAS(refusal("list: [{x: 1 m, repeat: {count: 2, every: {x: 1 s}}}]\n"), "own.yaml:1:47: 'every' adds '1 s' to '1 m' at own.yaml:1:12");
  EXPECT_HAS(refusal("list: [{x: red, repeat: {count: 2, every: {x: 1}}}]\n"), "'every' adds to 'red'");
  EXPECT_HAS(refusal("list: [{x: 1, repeat: {count: 2, every: {x: red}}}]\n"), "'every' adds 'red'");
  EXPECT_HAS(refusal("list: [{x: [1, 2], repeat: {count: 2, every: {x: [1]}}}]\n"), "'every' has a list of 1 where the entry has a list of 2");
  EXPECT_HAS(refusal("list: [{x: 1, repeat: {count: 2, every: 3}}]\n"), "every is a single value");
  EXPECT_HAS(refusal("x: $i\nlist: [{repeat: {count: 2}}]\n"), "there is no parameter 'i'");
}

// Expected: refused with its place, soon and in little memory, however it is written: two to the power of forty, and more.
TEST_F(Expand, ExpansionIsBounded) {
  std::string doubled = "parameters:\n  a0: [x, x]\n", aliases = "a0: &a0 [x, x]\n";
  for (int k = 1; k < 40; ++k) {
    const std::string n = std::to_string(k), o = std::to_string(k - 1);
    doubled += "  a" + n + ": [$a" + o + ", $a" + o + "]\n";
    aliases += "a" + n + ": &a" + n + " [*a" + o + ", *a" + o + "]\n";
  }
  EXPECT_HAS(refusal(doubled + "b: $a39\n"), "holds more than 500000 values");
  EXPECT_HAS(refusal(aliases), "holds more than");
  std::string text = "parameters:\n  a0: xxxxxxxx\n";
  for (int k = 1; k < 40; ++k) text += "  a" + std::to_string(k) + ": \"${a" + std::to_string(k - 1) + "}${a" + std::to_string(k - 1) + "}\"\n";
  EXPECT_HAS(refusal(text + "b: $a39\n"), "longer than 64 kB");
  EXPECT_HAS(refusal("list: [{repeat: {count: 4096}, x: [{repeat: {count: 4096, as: j}, x: [{repeat: {count: 4096, as: k}}]}]}]\n"),
             "holds more than 500000 values");
  put("nothing.yaml", "[]\n");
  EXPECT_HAS(refusal("list: [{repeat: {count: 4096}, x: [{repeat: {count: 4096, as: j}, include: nothing.yaml}]}]\n"), "holds more than 500000 values");
  std::string long_text = "parameters: {t: " + std::string(60000, 'x') + "}\nlist: [{repeat: {count: 4096}, x: [$t, $t, $t]}]\n";
  EXPECT_HAS(refusal(long_text), "256 MB");
  std::string deep = "parameters:\n  p0: x\n";
  for (int k = 1; k < 400; ++k) deep += "  p" + std::to_string(k) + ": $p" + std::to_string(k - 1) + "\n";
  EXPECT_HAS(refusal(deep + "b: $p399\n"), "more than 256 levels deep");
  std::string nested = "parameters:\n  p0: x\n";
  for (int k = 1; k < 100; ++k) nested += "  p" + std::to_string(k) + ": [$p" + std::to_string(k - 1) + "]\n";
  EXPECT_HAS(refusal(nested + "b: $p99\n"), "nested deeper than 64 levels");
  for (int k = 0; k < 12; ++k)  // 4^12 lists of one file's entries
    put(
        "e" + std::to_string(k) + ".yaml", "include: [" + [&] {
          std::string four;
          for (int n = 0; n < 4; ++n) four += (n ? ", e" : "e") + std::to_string(k + 1) + ".yaml";
          return four;
        }() + "]\n");
  put("e12.yaml", "list: [1, 2]\n");
  EXPECT_HAS(refusal("include: e0.yaml\n"), "the files put together hold more than");
}

// Expected: the identity is another when any file that is used is, or a root leads to another file of the same name; not when an unused one is.
TEST_F(Expand, IdentityHoldsAllFiles) {
  put("own/a.yaml", "x: 1\n");
  put("own/entry.yaml", "name: e\n");
  put("own/unused.yaml", "q: 1\n");
  put("r1/part.yaml", "y: 1\n");
  put("r2/part.yaml", "y: 2\n");
  const std::string scenario = "include: [a.yaml, part.yaml]\nlist: [{include: entry.yaml}]\n";
  const auto identity = [&](const char* root, const std::vector<std::string>& set = {}) {
    roots = {folder.path() / root};
    return expanded(scenario, set, "own").identity;
  };
  const std::string first = identity("r1");
  EXPECT_EQ(identity("r1"), first);
  EXPECT_NE(identity("r2"), first);
  EXPECT_NE(identity("r1", {"x=1"}), first);
  put("own/unused.yaml", "q: 2\n");
  EXPECT_EQ(identity("r1"), first);
  put("own/entry.yaml", "name: f\n");
  EXPECT_NE(identity("r1"), first);
  put("own/entry.yaml", "name: e\n");
  put("own/a.yaml", "x: 1 \n");
  EXPECT_NE(identity("r1"), first);
}

/// The blocks of a section of scenarios/README.md that begin with "# NAME.yaml", by that name.
std::map<std::string, std::string> filesOfSection(const std::string& title) {
  std::ifstream in(std::string(PITVIPER_SOURCE_DIR) + "/scenarios/README.md");
  std::map<std::string, std::string> files;
  std::string line, name;
  bool inside = false, block = false;
  while (std::getline(in, line)) {
    if (line.starts_with("## ")) inside = line == "## " + title;
    if (!inside) continue;
    if (line.starts_with("```")) {
      block = line == "```yaml";
      name.clear();
    } else if (block && name.empty() && line.starts_with("# ")) {
      name = line.substr(2);
    } else if (block && !name.empty()) {
      files[name] += line + "\n";
    }
  }
  return files;
}

// Expected: what the README shows is read, with what it says comes out of it.
TEST_F(Expand, TheExampleOfTheReadme) {
  const auto files = filesOfSection("Parts, parameters, salvos");
  ASSERT_EQ(files.size(), 3u);
  for (const auto& [name, content] : files) put(name, content);
  const Simulation sim = readScenario(folder.path() / "salvo.yaml", {}, findLibraries());
  ASSERT_EQ(sim.entities.size(), 5u);
  EXPECT_EQ(sim.entities[4].name, "missile_3");
  ASSERT_EQ(sim.lights.size(), 8u);
  EXPECT_EQ(sim.lights[7].name, "flare_7");
  EXPECT_EQ(sim.time.frames, 89);  // floor(1000 / 280 * 25)
}

}  // namespace
}  // namespace pitviper::test
