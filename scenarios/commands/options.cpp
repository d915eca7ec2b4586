#include "scenarios/commands/options.hpp"

#include <algorithm>
#include <charconv>

#include "sim/parameters/error.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {
namespace {
Location commandLine(const std::string& command) { return {"pitviper " + command, 0, 0, -1}; }
}  // namespace

Options::Options(const std::string& command, const Arguments& arguments, const std::vector<OptionSpec>& specs, size_t least, size_t most) {
  for (size_t i = 0; i < arguments.size(); ++i) {
    std::string a = arguments[i];
    if (a.size() < 2 || a[0] != '-' || std::isdigit(static_cast<unsigned char>(a[1]))) {
      words_.push_back(a);
      continue;
    }
    std::string attached;
    bool hasAttached = false;
    if (const size_t equals = a.find('='); equals != std::string::npos) {
      attached = a.substr(equals + 1);
      a.resize(equals);
      hasAttached = true;
    }
    const auto spec = std::find_if(specs.begin(), specs.end(), [&](const auto& s) { return s.name == a; });
    if (spec == specs.end()) {
      std::vector<std::string> names;
      for (const auto& s : specs) names.push_back(s.name);
      throw UserError(commandLine(command), "unknown option '" + a + "'", "an option of pitviper " + command + " --help", didYouMean(a, names, "remove it"));
    }
    std::string value;
    if (spec->value) {
      if (hasAttached) value = attached;
      else if (i + 1 < arguments.size()) value = arguments[++i];
      else throw UserError(commandLine(command), a + " has no value", "a value behind it", "see pitviper " + command + " --help");
    } else if (hasAttached) {
      throw UserError(commandLine(command), a + " takes no value", "the flag alone", "remove '=" + attached + "'");
    }
    if (!spec->many && values_.count(a)) throw UserError(commandLine(command), a + " given twice", "once", "remove one");
    values_[a].push_back(value);
  }
  if (words_.size() < least || words_.size() > most)
    throw UserError(commandLine(command), words_.size() < least ? "too few arguments" : "too many arguments ('" + words_[most] + "')",
                    std::to_string(least) + (most > least ? " to " + std::to_string(most) : ""), "see pitviper " + command + " --help");
}

std::string Options::value(const std::string& name, const std::string& otherwise) const {
  const auto found = values_.find(name);
  return found == values_.end() ? otherwise : found->second.front();
}

std::vector<std::string> Options::values(const std::string& name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? std::vector<std::string>{} : found->second;
}

const OptionSpec& rootOption() {
  static const OptionSpec spec{"--root", true, true};
  return spec;
}

std::vector<std::filesystem::path> rootsOf(const Options& options) {
  const auto names = options.values("--root");
  return {names.begin(), names.end()};
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
