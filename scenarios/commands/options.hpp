#pragma once
// A command of the program: one table of its options, from which its line is read, mistakes are refused and its help is printed.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

using Arguments = std::vector<std::string>;

/// Where what is written behind an option goes, and what it may be.
struct Target {
  /// `where` is "--option text". Errors: UserError.
  std::function<void(const std::string& text, const Location& where)> take;
  std::string limits = {};              ///< "4 to 4096; default 64"
  std::vector<std::string> words = {};  ///< "lockstep: simulated time moves ..."
};

Target into(bool& field);
Target into(std::string& field);
template <class Text>
Target into(std::vector<Text>& field) {
  return {[&field](const std::string& text, const Location&) { field.push_back(text); }};
}
/// What a number may be.
struct NumberLimits {
  double least, most;
  std::string unit = {};
  bool isBare = false;  ///< its unit may be left out
  std::string wrong = "no such quantity, or out of range";
};

Target numberTarget(const NumberLimits& limits, bool isWhole, std::optional<double> byDefault, std::function<void(double)> put);

/// A number, whole where the field is. What the field holds is its default, where that lies within the limits.
template <class Field>
Target number(Field& field, const NumberLimits& limits) {
  constexpr bool isWhole = std::is_same_v<Field, int> || std::is_same_v<Field, std::optional<int>>;
  return numberTarget(limits, isWhole, field, [&field](double v) {
    if constexpr (isWhole) field = static_cast<int>(v);
    else field = v;
  });
}

/// Names between commas.
Target someOf(std::vector<std::string>& field, const std::vector<std::string>& names, const std::string& what);

/// A word, what it stands for, and what that means.
template <class Field>
struct Word {
  std::string text;
  Field value;
  std::string about = {};
};

template <class Field>
Target oneOf(Field& field, const std::vector<Word<Field>>& words) {
  Target target;
  std::vector<std::string> names;
  for (const auto& w : words) {
    names.push_back(w.text);
    if (!w.about.empty()) target.words.push_back(w.text + ": " + w.about);
  }
  if (target.words.empty()) target.limits = listed(names);
  target.take = [&field, words, names](const std::string& text, const Location& where) {
    for (const auto& w : words)
      if (w.text == text) return void(field = w.value);
    throw unknownWord(where, where.file.substr(0, where.file.find(' ')) + " has no", text, names);
  };
  return target;
}

struct Option {
  std::string name;   ///< "--out"; empty: a heading above the rows that follow
  std::string value;  ///< "FOLDER": what stands behind it; "FOLDER...": it may come again; empty: nothing
  std::string help;
  Target to;
  std::string needs = {};  ///< an option, or the command's words, without which it would do nothing

  bool many() const { return value.ends_with("..."); }
  /// As a line has it: "--out FOLDER".
  std::string written() const { return name + (value.empty() ? "" : " " + (many() ? value.substr(0, value.size() - 3) : value)); }
};

template <class... Lists>
std::vector<Option> joined(std::vector<Option> all, const Lists&... others) {
  (all.insert(all.end(), others.begin(), others.end()), ...);
  return all;
}

struct CommandTitle {
  std::string name;   ///< "bench"; "bench --first": of `bench`, where --first stands behind it
  std::string words;  ///< "SCENARIO.yaml", "[NAME|FILE]", "[SCENARIO.yaml]..."
  std::string summary = {};
};

struct CommandLine : CommandTitle {
  std::string about;
  std::vector<Option> options;
  std::function<int(const Arguments& words)> run;
  std::string after = {};  ///< the options
};

/// Fills the command's fields and runs it. `others`: whose options are none of its own. Errors: UserError.
int perform(const CommandLine& command, const Arguments& arguments, const std::vector<CommandLine>& others = {});
/// Usage, options and the rest of each; what several have alike is told once.
std::string helpOf(const std::vector<CommandLine>& commands);

/// "a:b" or "a" as whole numbers; UserError otherwise.
std::pair<long long, long long> readRange(const std::string& text, const std::string& option);

}  // namespace pitviper
