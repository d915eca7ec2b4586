#include "scenarios/commands/options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include "sim/parameters/print.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

/// Of a help's lines, and of the names at their beginning.
constexpr std::size_t kWidth = 120, kNames = 24;

Location commandLine(const CommandLine& command) { return {"pitviper " + command.name, 0, 0, -1}; }

/// `first`, then the text's words in lines that begin at a column; its own line ends stay.
std::string wrapped(const std::string& first, const std::string& text, std::size_t column) {
  std::string out, line = first;
  std::istringstream paragraphs(text);
  const std::string margin(column, ' ');
  for (std::string paragraph; std::getline(paragraphs, paragraph); line = margin) {
    std::istringstream in(paragraph);
    for (std::string word; in >> word; line += (line.size() > column ? " " : "") + word)
      if (line.size() > column && line.size() + 1 + word.size() > kWidth) out += line + "\n", line = margin;
    out += (line.find_first_not_of(' ') == line.npos ? "" : line) + "\n";
  }
  return out;
}

std::string rowOf(const Option& o, const std::string& help) {
  if (o.name.empty()) return wrapped("", o.help, 0);
  std::string begin = "  " + o.written(), out;
  if (begin.size() + 2 > kNames) out = begin + "\n", begin.clear();
  begin.resize(kNames, ' ');
  std::string text = help;
  if (!o.to.limits.empty()) text += (text.empty() ? "" : " ") + ("(" + o.to.limits + ")");
  if (o.many()) text += "; repeatable";
  for (const std::string& word : o.to.words) text += "\n" + word;
  return out + wrapped(begin, text, kNames);
}

/// The least and the most words that "FILE.exr [SENSOR.yaml]" stands for.
std::pair<std::size_t, std::size_t> countsOf(const std::string& words) {
  std::pair<std::size_t, std::size_t> counts{0, 0};
  std::istringstream in(words);
  for (std::string word; in >> word;) {
    if (word[0] != '[') ++counts.first;
    counts.second += word.ends_with("...") ? 1000 : 1;
  }
  return counts;
}

UserError unknownOption(const CommandLine& command, const std::string& option, const std::vector<CommandLine>& others) {
  std::vector<std::string> names, owners;
  for (const Option& o : command.options) names.push_back(o.name);
  for (const CommandLine& other : others)
    if (other.name.ends_with(" " + option) || std::any_of(other.options.begin(), other.options.end(), [&](const Option& o) { return o.name == option; }))
      owners.push_back("pitviper " + other.name);
  if (!owners.empty())
    return {commandLine(command), option + " says nothing to pitviper " + command.name, "it with " + listed(owners, " or "), "remove it, or use one of those"};
  return {commandLine(command), "unknown option '" + option + "'", "an option of pitviper " + command.name + " --help", didYouMean(option, names, "remove it")};
}

}  // namespace

Target into(bool& field) {
  return {[&field](const std::string&, const Location&) { field = true; }};
}

Target into(std::string& field) {
  return {[&field](const std::string& text, const Location&) { field = text; }};
}

Target numberTarget(const NumberLimits& l, bool isWhole, std::optional<double> byDefault, std::function<void(double)> put) {
  const auto written = [&l](double v) { return print("%.10g", v) + (l.unit.empty() ? "" : " " + l.unit); };
  const bool isKnown = byDefault && *byDefault >= l.least && *byDefault <= l.most;
  const std::string range = written(l.least) + " to " + written(l.most), example = written(isKnown ? *byDefault : std::clamp(1.0, l.least, l.most));
  const auto take = [=](const std::string& text, const Location& where) {
    auto q = splitQuantity(text);
    if (q && q->unit.empty() && l.isBare) q->unit = l.unit;
    const auto value = q && (l.unit.empty() || !q->unit.empty()) ? convert(*q, l.unit) : std::nullopt;
    if (!value || !(*value >= l.least && *value <= l.most) || (isWhole && *value != std::floor(*value)))
      throw UserError(where, l.wrong,
                      (isWhole                      ? "a whole number, "
                       : l.unit.empty() || l.isBare ? "a number, "
                                                    : "a number with its unit, ") +
                          range,
                      "write " + where.file.substr(0, where.file.find(' ')) + " " + (example.find(' ') == example.npos ? example : "'" + example + "'"));
    put(*value);
  };
  return {take, range + (isKnown ? "; default " + example : "")};
}

Target someOf(std::vector<std::string>& field, const std::vector<std::string>& names, const std::string& what) {
  return {[=, &field](const std::string& text, const Location& where) {
            std::istringstream in(text);
            for (std::string name; std::getline(in, name, ',');) {
              if (std::find(names.begin(), names.end(), name) == names.end())
                throw UserError(where, "there is no " + what + " '" + name + "'", "some of " + listed(names) + ", between commas", didYouMean(name, names));
              field.push_back(name);
            }
          },
          listed(names)};
}

int perform(const CommandLine& command, const Arguments& arguments, const std::vector<CommandLine>& others) {
  Arguments words;
  std::map<std::string, int> given;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& a = arguments[i];
    if (a.size() < 2 || a[0] != '-' || std::isdigit(static_cast<unsigned char>(a[1]))) {
      words.push_back(a);
      continue;
    }
    const std::size_t equals = a.find('=');
    const std::string name = a.substr(0, equals);
    const auto option = std::find_if(command.options.begin(), command.options.end(), [&](const Option& o) { return o.name == name; });
    if (option == command.options.end()) throw unknownOption(command, name, others);
    std::string text;
    if (option->value.empty()) {
      if (equals != a.npos) throw UserError(commandLine(command), name + " takes no value", "the flag alone", "remove '" + a.substr(equals) + "'");
    } else if (equals != a.npos) text = a.substr(equals + 1);
    else if (i + 1 < arguments.size()) text = arguments[++i];
    else throw UserError(commandLine(command), name + " has no value", "a value behind it", "see pitviper " + command.name + " --help");
    if (given[name]++ && !option->many()) throw UserError(commandLine(command), name + " given twice", "once", "remove one");
    option->to.take(text, {name + (text.empty() ? "" : " " + text), 0, 0, -1});
  }
  const auto [least, most] = countsOf(command.words);
  if (words.size() < least || words.size() > most)
    throw UserError(commandLine(command), words.size() < least ? "too few arguments" : "too many arguments ('" + words[most] + "')",
                    command.words.empty() ? "none" : command.words, "see pitviper " + command.name + " --help");
  for (const Option& o : command.options) {
    const bool isOption = o.needs.starts_with("--");
    if (o.needs.empty() || !given.count(o.name) || (isOption ? given.count(o.needs) > 0 : !words.empty())) continue;
    const auto needed = std::find_if(command.options.begin(), command.options.end(), [&](const Option& other) { return other.name == o.needs; });
    throw UserError({o.name, 0, 0, -1}, "it does nothing without " + o.needs, "'" + (isOption ? needed->written() : o.needs) + "' beside it",
                    "add it, or remove " + o.name);
  }
  return command.run(words);
}

std::string helpOf(const std::vector<CommandLine>& commands) {
  std::string out;
  std::map<std::string, std::string> told;
  for (const CommandLine& c : commands) {
    std::string usage = "pitviper " + c.name, line = usage;
    std::vector<std::string> pieces{c.words};
    for (const Option& o : c.options)
      if (!o.name.empty()) pieces.push_back("[" + o.written() + (o.many() ? "]..." : "]"));
    out += out.empty() ? "" : "\n\n";
    for (const std::string& piece : pieces) {
      if (line.size() + 1 + piece.size() > kWidth) out += line + "\n", line.assign(usage.size(), ' ');
      if (!piece.empty()) line += " " + piece;
    }
    out += line + "\n\n" + wrapped("", c.about, 0);
    for (const Option& o : c.options) {
      if (&o == &c.options[0] || o.name.empty()) out += "\n";
      const auto [at, isNew] = told.emplace(o.help, o.name);
      out += rowOf(o, isNew || o.name != at->second ? o.help : "as above");
    }
    if (!c.after.empty()) out += "\n" + wrapped("", c.after, 0);
  }
  return out;
}

std::pair<long long, long long> readRange(const std::string& text, const std::string& option) {
  auto number = [&](std::string_view t) {
    long long v = 0;
    const auto [end, error] = std::from_chars(t.data(), t.data() + t.size(), v);
    if (error != std::errc() || end != t.data() + t.size())
      throw UserError({option, 0, 0, -1}, "'" + text + "' is not a range", "two whole numbers 'a:b' or one", "write " + option + " 0:9");
    return v;
  };
  const size_t colon = text.find(':');
  if (colon == std::string::npos) return {number(text), number(text)};
  return {number(std::string_view(text).substr(0, colon)), number(std::string_view(text).substr(colon + 1))};
}

}  // namespace pitviper
