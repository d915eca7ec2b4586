// Values written back into a scenario's text: what changes, what stays, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "scenarios/reader/yaml_tree.hpp"
#include "scenarios/view/yaml_edit.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/read_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

std::string edited(const std::string& text, const std::string& path, const std::string& value) { return withChanges(text, "own.yaml", {{path, value}}); }

std::string editRefusal(const std::string& text, const std::string& path, const std::string& value) {
  try {
    edited(text, path, value);
  } catch (const UserError& e) {
    return e.what();
  }
  return "nothing refused";
}

std::vector<fs::path> shippedScenarios() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(PITVIPER_SOURCE_DIR) / "scenarios"))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::size_t offsetOf(const std::string& text, const Location& where) {
  std::size_t from = 0;
  for (int line = 1; line < where.line; ++line) from = text.find('\n', from) + 1;
  return from + static_cast<std::size_t>(where.column - 1);
}

struct Leaf {
  std::string path;
  const Value* value;
};

/// All values of a tree, or its single ones that begin with a digit. Items go by number, or by name where `named`.
void collectLeaves(const Value& v, const std::string& path, bool numbersAlone, bool named, std::vector<Leaf>& leaves) {
  const bool number = v.kind == Value::Kind::Scalar && v.text.find_first_of("0123456789") == (v.text.starts_with('-') ? 1u : 0u);
  if (!path.empty() && (number || !numbersAlone)) leaves.push_back({path, &v});
  const std::string front = path.empty() ? "" : path + ".";
  for (std::size_t k = 0; k < v.items.size(); ++k) {
    const Value* name = named && v.items[k].kind == Value::Kind::Map ? v.items[k].find("name") : nullptr;
    collectLeaves(v.items[k], front + (name ? name->text : std::to_string(k)), numbersAlone, named, leaves);
  }
  for (const auto& [key, item] : v.entries)
    if (key.find('.') == std::string::npos) collectLeaves(item, front + key, numbersAlone, named, leaves);
}

std::string overridden(Value tree, const YamlChange& change) {
  applyOverride(tree, change.path + "=" + change.value);
  return wordsOf(tree);
}

TEST(YamlEdit, ValuesOfAllStyles) {
  EXPECT_EQ(edited("a: 1 m   # one\nb: 2\n", "a", "3.5 m"), "a: 3.5 m   # one\nb: 2\n");
  EXPECT_EQ(edited("a: '1 m' # one\n", "a", "it's"), "a: 'it''s' # one\n");
  EXPECT_EQ(edited("a: \"x # \\\" y\"\t# one\n", "a", "z"), "a: \"z\"\t# one\n");
  EXPECT_EQ(edited("a: {b: 1 m, c: [1, 2]}  # one\n", "a.b", "2 m"), "a: {b: 2 m, c: [1, 2]}  # one\n");
  EXPECT_EQ(edited("a: {b: 1 m, c: [1, 2]}  # one\n", "a.c.1", "5"), "a: {b: 1 m, c: [1, 5]}  # one\n");
  EXPECT_EQ(edited("p: [1 m, 2 m,\n    3 m]  # place\n", "p", "[4 m, 2 m, 5 m]"), "p: [4 m, 2 m,\n    5 m]  # place\n");
  EXPECT_EQ(edited("p: [1 m, 2 m,\n    3 m]  # place\nq: 1\n", "p", "jet"), "p: jet  # place\nq: 1\n");
  EXPECT_EQ(edited("a:\n  b: 1\n  c:\n    d: 2\n# next\ne: 3\n", "a", "7 K"), "a: 7 K\n# next\ne: 3\n");
  EXPECT_EQ(edited("a:   # head\n  - 1 m\n  - 2 m   # last\n\ne: 3\n", "a", "[3 m]"), "a: [3 m]   # head   # last\n\ne: 3\n");
  EXPECT_EQ(edited("a:\n- 1 m\n- 2 m\ne: 3\n", "a", "[3 m, 4 m]"), "a: [3 m, 4 m]\ne: 3\n");
  EXPECT_EQ(edited("a: |\n  one\n  two\n\nb: 1\n", "a", "three"), "a: three\n\nb: 1\n");
  EXPECT_EQ(edited("a: |\n    one\n  # c\nb: 1\n", "a", "three"), "a: three\n  # c\nb: 1\n");
  EXPECT_EQ(edited("l:\n  - >-\n    one\n    two\n  - 2\n", "l.0", "three"), "l:\n  - three\n  - 2\n");
  EXPECT_EQ(edited("a: one\n   two\n# c\nb: 1\n", "a", "three"), "a: three\n# c\nb: 1\n");
  EXPECT_EQ(edited("a:    # none yet\nb: 1\n", "a", "3 m"), "a: 3 m    # none yet\nb: 1\n");
  EXPECT_EQ(edited("a: ~ # none\n", "a", "3 m"), "a: 3 m # none\n");
  EXPECT_EQ(edited("a: {b: null, c: 1}\n", "a.b", "3 m"), "a: {b: 3 m, c: 1}\n");
  EXPECT_EQ(edited("a: {b: , c: 1}\n", "a.b", "3 m"), "a: {b: 3 m , c: 1}\n");
  EXPECT_EQ(edited("a: {b, c: 1}\n", "a.b", "3 m"), "a: {b: 3 m, c: 1}\n");
  EXPECT_EQ(edited("l:\n  -  # none\n  - 2\n", "l.0", "3 m"), "l:\n  - 3 m  # none\n  - 2\n");
  EXPECT_EQ(edited("a: &x 3 m  # mine alone\n", "a", "4 m"), "a: &x 4 m  # mine alone\n");
  EXPECT_EQ(edited("\xC3\xA4: {\xC3\xB6: \xC3\xBC, b: 1}\n", "\xC3\xA4.b", "2"), "\xC3\xA4: {\xC3\xB6: \xC3\xBC, b: 2}\n");
  EXPECT_EQ(edited("\xEF\xBB\xBF"
                   "a: 1\n",
                   "a", "2"),
            "\xEF\xBB\xBF"
            "a: 2\n");
  EXPECT_EQ(edited("a: 1", "a", "[2, 3]"), "a: [2, 3]");
}

TEST(YamlEdit, ABlockListWithCommentsWithinKeepsThem) {
  EXPECT_EQ(edited("p:\n  - 1 m   # east\n  - 2 m   # north\n", "p", "[1 m, 5 m]"), "p:\n  - 1 m   # east\n  - 5 m   # north\n");
}

TEST(YamlEdit, HostileLayout) {
  const std::string maps = "l:\n  - name: x   # first\n    position: [1 m, 2 m]\t# there\n    of:\n      a: 1\n  - {name: y, position: 2 m}\n# end\n";
  EXPECT_EQ(edited(maps, "l.x.position", "5 m"),
            "l:\n  - name: x   # first\n    position: 5 m\t# there\n    of:\n      a: 1\n  - {name: y, position: 2 m}\n# end\n");
  EXPECT_EQ(edited(maps, "l.x.of.b", "5 m"),
            "l:\n  - name: x   # first\n    position: [1 m, 2 m]\t# there\n    of:\n      a: 1\n      b: 5 m\n  - {name: y, position: 2 m}\n# end\n");
  EXPECT_EQ(edited(maps, "l.x.of", "5 m"), "l:\n  - name: x   # first\n    position: [1 m, 2 m]\t# there\n    of: 5 m\n  - {name: y, position: 2 m}\n# end\n");
  EXPECT_EQ(edited(maps, "l.0", "5 m"), "l:\n  - 5 m\n  - {name: y, position: 2 m}\n# end\n");
  EXPECT_EQ(edited(maps, "l.y.position", "[1 m, 3 m]"),
            "l:\n  - name: x   # first\n    position: [1 m, 2 m]\t# there\n    of:\n      a: 1\n  - {name: y, position: [1 m, 3 m]}\n# end\n");
  EXPECT_EQ(edited("a: {t: 'x: #1, ]}', u: it's#2,  # ] } comment\n   v: [a, \"]\"] }\n", "a.v", "1"),
            "a: {t: 'x: #1, ]}', u: it's#2,  # ] } comment\n   v: 1 }\n");
  EXPECT_EQ(edited("a: b:c d#e  # x: y\n", "a", "1"), "a: 1  # x: y\n");
  EXPECT_EQ(edited("a:\t1 m\t# tab\n", "a", "2 m"), "a:\t2 m\t# tab\n");
  EXPECT_EQ(edited("\"a\": {\"b\":1, 'c' : 2}\n", "a.b", "7"), "\"a\": {\"b\":7, 'c' : 2}\n");
}

TEST(YamlEdit, ValuesThatNeedQuotesGetThem) {
  EXPECT_EQ(edited("a: {b: 1}\n", "a.b", "'x, y'"), "a: {b: \"x, y\"}\n");
  EXPECT_EQ(edited("a: 1\n", "a", "'null'"), "a: \"null\"\n");
  EXPECT_EQ(edited("a: 1\n", "a", "\"x\\ny: # z\""), "a: \"x\\x0ay: # z\"\n");
  EXPECT_EQ(edited("a: 1\n", "a", "null"), "a: null\n");
  EXPECT_EQ(edited("a: 1\n", "a", "b: 2\nc: [3]"), "a: {b: 2, c: [3]}\n");
  EXPECT_EQ(edited("a: 1\n", "a", "-3 m"), "a: -3 m\n");
  // Each is read back as itself, at the top and within brackets.
  for (const std::string text :
       {"",  " ",  "-",  "- a", "?",   "? a", ":", "a:", "a: b", "a #b", "#a",  "&a",  "*a",   "!a",  "|",    ">",        "%a", "@a",  "`a",
        "'", "\"", "\\", "~",   "---", "...", "[", "]",  "{a",   "a}",   "a,b", "\ta", "a\tb", "a b", "\x7f", "\xC3\xA4", "-a", "a'b", "1e5"}) {
    std::string quoted = "\"";
    for (const char c : text)
      quoted += c == '"' || c == '\\' ? std::string("\\") + c : c == '\t' ? std::string("\\t") : c == '\x7f' ? std::string("\\x7f") : std::string(1, c);
    quoted += "\"";
    EXPECT_EQ(parseYaml(edited("a: 1\nb: 2\n", "a", quoted), "x").find("a")->text, text);
    EXPECT_EQ(parseYaml(edited("{a: 1, b: 2}\n", "a", quoted), "x").find("a")->text, text);
    EXPECT_EQ(parseYaml(edited("a: '1'\nb: 2\n", "a", quoted), "x").find("a")->text, text);
  }
}

TEST(YamlEdit, KeysAreAdded) {
  EXPECT_EQ(edited("a: {b: 1 m }  # one\n", "a.c", "2 m"), "a: {b: 1 m, c: 2 m }  # one\n");
  EXPECT_EQ(edited("a: {}\n", "a.c.d", "2 m"), "a: {c: {d: 2 m}}\n");
  EXPECT_EQ(edited("a: {b: 1,\n}\n", "a.c", "2"), "a: {b: 1, c: 2,\n}\n");
  EXPECT_EQ(edited("a:\n  b: 1  # one\n\n# two\nc: 1", "a.d", "2"), "a:\n  b: 1  # one\n  d: 2\n\n# two\nc: 1");
  EXPECT_EQ(edited("a: 1", "b", "2"), "a: 1\nb: 2");
  EXPECT_EQ(edited("a: |\n  text\nb: 1\n", "c", "2"), "a: |\n  text\nb: 1\nc: 2\n");
  EXPECT_EQ(edited("a:\n  b:\n  c:  # none\nd: 1\n", "a.e", "2"), "a:\n  b:\n  c:  # none\n  e: 2\nd: 1\n");
  EXPECT_EQ(edited("e:\n  - name: jet\n    shape: {model: jet}\n", "e.jet.parts.nozzle.temperature", "900 K"),
            "e:\n  - name: jet\n    shape: {model: jet}\n    parts: {nozzle: {temperature: 900 K}}\n");
}

TEST(YamlEdit, AKeyOfFirstLightsCameraKeepsAllElse) {
  const std::string text = readWholeFile(fs::path(PITVIPER_SOURCE_DIR) / "scenarios" / "first_light.yaml");
  const std::string line = "    truth: [range, entity, temperature]";
  const std::size_t at = text.find(line);
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(edited(text, "cameras.seeker.roll", "3 deg"), text.substr(0, at) + line + "\n    roll: 3 deg" + text.substr(at + line.size()));
  std::string moved = text;
  const std::string old = "position: [1.4 m, 0 m, 0 m]   # in the dome";
  moved.replace(moved.find(old), old.size(), "position: [1.5 m, 0 m, -2 m]   # in the dome");
  EXPECT_EQ(edited(text, "cameras.seeker.position", "[1.5 m, 0 m, -2 m]"), moved);
}

TEST(YamlEdit, CarriageReturnsStay) {
  EXPECT_EQ(edited("a: 1 m\r\nb: x\r\n", "a", "2 m"), "a: 2 m\r\nb: x\r\n");
  EXPECT_EQ(edited("a: 1 m  # c\r\nb: x\r\n", "c", "2 m"), "a: 1 m  # c\r\nb: x\r\nc: 2 m\r\n");
  EXPECT_EQ(edited("a:\r\n  - 1\r\n  - 2\r\nb: x\r\n", "a", "[3]"), "a: [3]\r\nb: x\r\n");
  EXPECT_EQ(edited("a: |\r\n  x\r\n  y\r\nb: x\r\n", "a", "[3]"), "a: [3]\r\nb: x\r\n");
}

TEST(YamlEdit, RefusesWhatIsNotTheFilesOwn) {
  const auto expect = [](const std::string& text, const std::string& path, const std::string& place, const std::string& reason) {
    const std::string message = editRefusal(text, path, "3 m");
    EXPECT_TRUE(message.starts_with("own.yaml:" + place + ": ")) << message;
    EXPECT_NE(message.find(reason), std::string::npos) << message;
    EXPECT_NE(message.find("fix: copy it as --set " + path + "='3 m'"), std::string::npos) << message;
  };
  expect("extends: base.yaml\nname: x\n", "sun.elevation", "1:10", "comes from another file");
  expect("extends: base.yaml\nname: x\n", "cameras.seeker.position", "1:10", "comes from another file");
  expect("include: [base.yaml]\ne: [{a: 1}]\n", "e.0.a", "1:10", "entries of other files");
  expect("include: [base.yaml]\ne: [{a: 1}]\n", "e", "1:10", "joined");
  expect("include: [base.yaml]\nsun: {a: 1}\n", "sun.b.c", "1:10", "comes from another file");
  expect("e:\n  - include: jet.yaml\n  - {name: a, x: 1}\n", "e.jet.x", "2:5", "included or repeated");
  expect("e:\n  - include: jet.yaml\n  - {name: a, x: 1}\n", "e.1.x", "2:5", "the numbers count");
  expect("e:\n  - {name: a, x: 1, repeat: {count: 3}}\n", "e.a_1.x", "2:5", "included or repeated");
  expect("e:\n  - {name: a, x: 1, repeat: {count: 3}}\n", "e.a.x", "2:5", "repeated");
  expect("a: $speed\n", "a", "1:4", "worked out from '$speed'");
  expect("a: $place\n", "a.x", "1:4", "worked out");
  expect("a: [1, \"= 2 * $n\"]\n", "a", "1:8", "worked out");
  expect("air: clear_us76\n", "air.visibility", "1:6", "is not in this file");
  expect("a: &x {b: 1}\nc: *x\n", "a.b", "1:4", "is used elsewhere, as *x");
  expect("a: {b: &x 1}\nc: *x\n", "a", "1:8", "is used elsewhere, as *x");
  expect("a: &x {b: 1}\nc: *x\n", "c.b", "2:4", "here is *x");
  expect("a: &x 1\nc: *x\n", "c", "2:4", "here is *x");
  expect("a: &x ~\nc: *x\n", "c", "2:4", "here is *x");
  expect("a: &x ~\nc: *x\n", "a", "1:4", "is used elsewhere");
  expect("a: [1, 2]\n", "a.2", "1:4", "is not in this list");
  expect("a: {b: 1}\n", "parameters.x", "1:1", "no parameter");
  expect("a:\nb: 1\n", "a.c", "1:1", "'a' holds nothing");
  expect("a: {b: 1}\n", "a..b", "1:1", "no path");
  EXPECT_NE(editRefusal("a: 1\n", "a", "$x").find("worked out"), std::string::npos);
}

TEST(YamlEdit, WhatStandsInAFileThatHasOthersBelowItChanges) {
  EXPECT_EQ(edited("extends: b.yaml\nsun: {a: 1}\n", "sun.b.c", "2"), "extends: b.yaml\nsun: {a: 1, b: {c: 2}}\n");
  EXPECT_EQ(edited("extends: b.yaml\nname: x\n", "accuracy", "2 %"), "extends: b.yaml\nname: x\naccuracy: 2 %\n");
  EXPECT_EQ(edited("include: b.yaml\ne: [{name: x, a: 1}]\n", "e.x.a", "[2, 3]"), "include: b.yaml\ne: [{name: x, a: [2, 3]}]\n");
  EXPECT_EQ(edited("e:\n  - {name: a, x: 1}\n  - include: jet.yaml\n", "e.0.x", "2"), "e:\n  - {name: a, x: 2}\n  - include: jet.yaml\n");
}

TEST(YamlEdit, AValueThatIsTheSameStaysAsItIsWritten) {
  const std::string text = "a:\n  - '1'\n  - 2\n";
  EXPECT_EQ(edited(text, "a", "[1, 2]"), text);
}

TEST(YamlEdit, ParametersChangeWhereTheyAreDeclared) {
  EXPECT_EQ(edited("parameters: {v: 3 m/s}\na: $v\n", "parameters.v", "4 m/s"), "parameters: {v: 4 m/s}\na: $v\n");
  EXPECT_EQ(edited("extends: b.yaml\nparameters: {v: 3 m/s}\n", "parameters.w", "4"), "extends: b.yaml\nparameters: {v: 3 m/s, w: 4}\n");
}

/// 30 numbers of each shipped scenario: the text differs within that number's characters alone.
TEST(YamlEdit, NumbersOfShippedScenarios) {
  std::mt19937 random(11);
  int done = 0;
  for (const fs::path& file : shippedScenarios()) {
    const std::string text = readWholeFile(file);
    const Value tree = parseYaml(text, "own.yaml");
    std::vector<Leaf> leaves, named;
    collectLeaves(tree, "", true, false, leaves);
    collectLeaves(tree, "", true, true, named);
    leaves.insert(leaves.end(), named.begin(), named.end());
    std::shuffle(leaves.begin(), leaves.end(), random);
    int here = 0;
    for (const Leaf& leaf : leaves) {
      if (here == 30) break;
      const std::string number = std::to_string(std::uniform_int_distribution<int>(1, 9999)(random));
      const std::size_t unit = leaf.value->text.find(' ');
      const YamlChange change{leaf.path, number + (unit == std::string::npos ? "" : leaf.value->text.substr(unit))};
      std::string changed;
      try {
        changed = withChanges(text, "own.yaml", {change});
      } catch (const UserError& e) {
        const std::string message = e.what();
        EXPECT_TRUE(message.find("is used elsewhere") != std::string::npos || message.find("here is *") != std::string::npos ||
                    message.find("repeated") != std::string::npos)
            << file << " " << message;
        continue;
      }
      const std::size_t at = offsetOf(text, leaf.value->where) + (leaf.value->quoted ? 1 : 0);
      std::string wanted = text;
      ASSERT_EQ(text.compare(at, leaf.value->text.size(), leaf.value->text), 0) << file << " " << leaf.path;
      EXPECT_EQ(changed, wanted.replace(at, leaf.value->text.size(), change.value)) << file << " " << leaf.path;
      EXPECT_EQ(wordsOf(parseYaml(changed, "own.yaml")), overridden(tree, change)) << file << " " << leaf.path;
      ++here, ++done;
    }
  }
  RecordProperty("numbers", done);
  EXPECT_GT(done, 400);  // 22 files, few of them with less than 30 numbers of their own
}

/// All styles within each other.
const char* const kMixedStyles = R"(# head
name: mixed   # one
"quoted key": {"x":1, 'y': [ 1 , 2,
     # within
     "a, b # c" ], z: , w }
same:
- 1 m   # first
-
- - a
  - [b, c]
  -
    k: 1
    l:
- name: item
  text: |-
      literal # no comment
      : - [

    # a comment
  folded: >2
      deep
    less
  plain: it's {a} [b]
    going on
  last:     # empty
mine: &mine
  # between
  a: 1
  b: {c: {d: {}}}
tagged: !!str 5   # five
nulls: [~, null, "null", '']
long: "over
  lines # here"
deep:
    list:
    -   a: 1
        b: 2

    -   {a: 1, b: [ ] }
    # below
end: 1)";

std::string withCommentsOnEachLine(const std::string& text) {
  std::string out;
  int line = 1;
  for (std::size_t from = 0; from < text.size(); ++line) {
    const std::size_t end = std::min(text.size(), text.find('\n', from));
    out += text.substr(from, end - from) + " # c" + std::to_string(line) + ";\n";
    from = end + 1;
  }
  return out;
}

int lastLineOf(const Value& v) {
  int line = v.where.line;
  for (const Value& item : v.items) line = std::max(line, lastLineOf(item));
  for (const auto& [key, item] : v.entries) line = std::max(line, lastLineOf(item));
  return line;
}

/// Any value for any other, with both line ends: what is not refused is what --set gives, and comments outside of the value stay.
TEST(YamlEdit, RandomChangesOfShippedScenariosCorruptNothing) {
  std::mt19937 random(12);
  const std::vector<std::string> values = {"1.25 m", "[1 m, -2 m, 3 m]", "{a: 1, b: [x, 'y, z']}", "'a: b # c'", "null", "[]",
                                           "{}",     "\"q\\\"'\"",       "x: {y: [1, {z: 2}]}"};
  const std::vector<std::string> keys = {"", "", "", ".fresh", ".fresh.deeper", ".0", ".name"};
  struct Shipped {
    std::string text;
    Value tree;
    bool commented;
  };
  int commentedFiles = 0;
  std::vector<Shipped> shipped;
  for (const fs::path& file : shippedScenarios()) {
    const std::string text = readWholeFile(file), commented = withCommentsOnEachLine(text);
    const std::string words = wordsOf(parseYaml(text, "own.yaml"));
    Value tree = parseYaml(commented, "own.yaml");
    const bool same = wordsOf(tree) == words;  // no text in quotes goes on over lines
    commentedFiles += same;
    if (!same) tree = parseYaml(text, "own.yaml");
    shipped.push_back({same ? commented : text, std::move(tree), same});
  }
  EXPECT_GT(commentedFiles, 15);
  for (int k = 0; k < 6; ++k) shipped.push_back({kMixedStyles, parseYaml(kMixedStyles, "own.yaml"), false});
  const auto any = [&](std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random); };
  int written = 0;
  for (int k = 0; k < 3000 && written < 300; ++k) {
    const Shipped& from = shipped[any(shipped.size())];
    std::string text = from.text;
    std::vector<Leaf> leaves;
    collectLeaves(from.tree, "", false, k % 2 == 0, leaves);
    const bool carriageReturns = k % 3 == 0;
    if (carriageReturns)
      for (std::size_t i = text.find('\n'); i != std::string::npos; i = text.find('\n', i + 2)) text.insert(i, "\r");
    const Leaf& leaf = leaves[any(leaves.size())];
    const YamlChange change{leaf.path + keys[any(keys.size())], values[any(values.size())]};
    std::string changed;
    try {
      changed = withChanges(text, "own.yaml", {change});
    } catch (const UserError& e) {
      EXPECT_EQ(std::string(e.what()).find("cannot be kept"), std::string::npos) << change.path << "=" << change.value << " " << e.what();
      continue;
    }
    ++written;
    EXPECT_EQ(wordsOf(parseYaml(changed, "own.yaml")), overridden(from.tree, change)) << change.path << "=" << change.value;
    const int lines = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
    for (int line = 1; from.commented && line <= lines; ++line)
      if (line < leaf.value->where.line || line >= lastLineOf(*leaf.value)) {
        EXPECT_NE(changed.find(" # c" + std::to_string(line) + ";"), std::string::npos) << change.path << "=" << change.value << " line " << line;
      }
    const auto lone = [](const std::string& t) {
      int count = 0;
      for (std::size_t i = 0; i < t.size(); ++i) count += t[i] == '\n' && (i == 0 || t[i - 1] != '\r');
      return count;
    };
    if (carriageReturns) {
      EXPECT_EQ(lone(changed), 0) << change.path << "=" << change.value;
    } else {
      EXPECT_EQ(changed.find('\r'), std::string::npos);
    }
  }
  EXPECT_EQ(written, 300);
}

TEST(YamlEdit, SeveralChangesOneAfterTheOther) {
  EXPECT_EQ(withChanges("a: {b: 1}\n", "own.yaml", {{"a.c.d", "2"}, {"a.c.e", "3"}, {"a.b", "4"}}), "a: {b: 4, c: {d: 2, e: 3}}\n");
}

TEST(YamlEdit, AFileIsReplacedWhole) {
  const TemporaryFolder folder;
  const fs::path file = folder.put("s.yaml", "a: 1 # one\n"), link = folder.path() / "link.yaml";
  fs::create_symlink(file, link);
  writeChanges(link, {{"a", "2"}});
  EXPECT_EQ(readWholeFile(file), "a: 2 # one\n");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_THROW(writeChanges(file, {{"a", "3"}, {"a.b", "3"}}), UserError);
  EXPECT_EQ(readWholeFile(file), "a: 2 # one\n");
}

TEST(YamlEdit, OptionsForAShell) {
  const std::vector<YamlChange> changes = {{"cameras.seeker.position", "[1 m, 2 m, 3 m]"}, {"a b.c", "it's $x"}, {"accuracy", "0.01"}};
  EXPECT_EQ(asSetOptions(changes), "--set cameras.seeker.position='[1 m, 2 m, 3 m]' --set 'a b.c'='it'\\''s $x' --set accuracy=0.01");
}

TEST(YamlEdit, NumbersInFewDigits) {
  EXPECT_EQ(numberText(3.2496, "deg", 0.01), "3.25 deg");
  EXPECT_EQ(numberText(1.5000001, "m", 1e-3), "1.5 m");
  EXPECT_EQ(numberText(-0.0004, "m", 0.001), "0 m");
  EXPECT_EQ(numberText(1234.4, "K", 1.0), "1234 K");
  EXPECT_EQ(numberText(2.5e-6, "m", 1e-9), "2.5e-06 m");
  EXPECT_EQ(numberText(0.1, "", 0.0), "0.1");
  std::mt19937 random(13);
  for (int k = 0; k < 200; ++k) {
    const double value = std::uniform_real_distribution<double>(-1000.0, 1000.0)(random), resolution = std::pow(10.0, -(k % 7));
    EXPECT_LE(std::abs(std::stod(numberText(value, "m", resolution)) - value), 0.5 * resolution);
    EXPECT_EQ(std::stod(numberText(value, nullptr, 0.0)), value);
  }
}

}  // namespace
}  // namespace pitviper::test
