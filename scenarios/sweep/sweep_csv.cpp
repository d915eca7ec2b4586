#include "scenarios/sweep/sweep_csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace pitviper {
namespace {

/// By RFC 4180: in quotes where it has to be.
std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string csvHead(const std::string& name, const std::string& unit) { return csvCell(name + " [" + (unit.empty() ? "1" : unit) + "]"); }

}  // namespace

std::string numberThatReadsBack(double value) {
  if (std::isnan(value)) return "";
  // Whole numbers up to here are exact in a double.
  constexpr double kMostWhole = 9007199254740992.0;
  char buffer[40];
  const bool whole = value == std::floor(value) && std::abs(value) < kMostWhole;
  return {buffer,
          (whole ? std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed) : std::to_chars(buffer, buffer + sizeof buffer, value)).ptr};
}

std::string csvOf(const SweepIdentity& identity, std::vector<SweepRow> rows) {
  std::sort(rows.begin(), rows.end(), [](const SweepRow& a, const SweepRow& b) { return a.sample < b.sample; });
  const std::vector<MeasureColumn> columns = measureColumns(identity);
  std::string csv = "sample,seed";
  for (const SweepFactor& f : identity.factors) csv += "," + (f.choices.empty() ? csvHead(f.name, f.unit) : csvCell(f.name));
  for (const MeasureColumn& c : columns) csv += "," + csvHead(c.name, c.unit);
  csv += ",why\n";
  for (const SweepRow& r : rows) {
    csv += std::to_string(r.sample) + "," + std::to_string(r.seed);
    for (std::size_t i = 0; i < identity.factors.size(); ++i) {
      const SweepFactor& f = identity.factors[i];
      csv += "," + (f.choices.empty() ? numberThatReadsBack(r.factors.at(i)) : csvCell(choiceWord(f, r.factors.at(i))));
    }
    for (std::size_t i = 0; i < columns.size(); ++i) csv += "," + (r.measures.empty() && !r.why.empty() ? "" : numberThatReadsBack(r.measures.at(i)));
    csv += "," + csvCell(r.why) + "\n";
  }
  return csv;
}

}  // namespace pitviper
