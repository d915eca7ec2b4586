#include "scenarios/sweep/sweep_identity.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace pitviper {
namespace {

/// SQLite has at most 2000 columns in a table.
constexpr std::size_t kMostColumns = 1900;

/// As SQLite compares names: letters of ASCII only.
std::string lowerCase(std::string name) {
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return name;
}

bool printable(const std::string& text) {
  return !text.empty() && std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; });
}

void refuseUnprintable(const std::string& text, const Location& where, const std::string& what) {
  if (!printable(text)) throw UserError(where, what + " '" + text + "' is empty or holds a control character", "printable characters", "rename it");
}

}  // namespace

std::vector<MeasureColumn> measureColumns(const SweepIdentity& identity) {
  std::vector<MeasureColumn> columns;
  for (const Measure& m : identity.measures)
    for (std::size_t i = 0; i < m.names.size(); ++i) columns.push_back({m.names[i], i < m.units.size() ? m.units[i] : ""});
  return columns;
}

void setMeasureUnits(SweepIdentity& identity, const std::vector<std::string>& units) {
  if (units.size() != measureColumns(identity).size()) throw std::invalid_argument("setMeasureUnits: a unit for each column");
  std::size_t column = 0;
  for (Measure& m : identity.measures) {
    m.units.resize(m.names.size());
    for (std::string& unit : m.units)
      if (const std::string& given = units[column++]; !given.empty()) unit = given;
  }
}

const std::string& choiceWord(const SweepFactor& choice, double value) {
  // Written so that a NaN is refused.
  if (!(value >= 0.0 && value < static_cast<double>(choice.choices.size())) || value != static_cast<double>(static_cast<std::size_t>(value)))
    throw std::invalid_argument("choiceWord: '" + choice.name + "' has no such choice");
  return choice.choices[static_cast<std::size_t>(value)];
}

void refuseUnfitNames(const SweepIdentity& identity, const std::string& file) {
  std::set<std::string> taken{"sample", "seed", "why"};
  const auto take = [&](const std::string& name, const Location& where, const std::string& what) {
    refuseUnprintable(name, where, what);
    if (!taken.insert(lowerCase(name)).second)
      throw UserError(where, "two columns of the results would be named '" + name + "'",
                      "names of factors and measures that differ, upper and lower case being one, other than sample, seed and why", "rename the " + what);
  };
  const Location here{file, 0, 0, -1};
  for (const SweepFactor& f : identity.factors) {
    take(f.name, here, "factor");
    for (const std::string& word : f.choices) refuseUnprintable(word, here, "choice of '" + f.name + "'");
    if (std::set<std::string>(f.choices.begin(), f.choices.end()).size() != f.choices.size())
      throw UserError(here, "the factor '" + f.name + "' has a choice twice", "choices that differ", "leave one out");
  }
  for (const Measure& m : identity.measures)
    for (const std::string& name : m.names) take(name, m.where.file.empty() ? here : m.where, "measure");
  if (taken.size() > kMostColumns)
    throw UserError(here, "factors and measures are " + std::to_string(taken.size()) + " columns", std::to_string(kMostColumns) + " at most",
                    "measure less, or in two sweeps");
}

}  // namespace pitviper
