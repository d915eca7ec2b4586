#include "atmosphere/tape7_fields.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "sim/parameters/readable_text.hpp"

namespace pitviper::tape7 {
namespace {

const char* const kUnchanged = "give the file as MODTRAN wrote it, its columns unchanged";

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// A Fortran number as C++ reads it, "1.2D-3" and "1.2-103" too; "" if it is none.
std::string plainNumber(std::string_view t) {
  std::string out;
  size_t i = 0;
  if (i < t.size() && (t[i] == '+' || t[i] == '-')) {
    if (t[i] == '-') out += '-';
    ++i;
  }
  size_t digits = 0;
  for (; i < t.size() && isDigit(t[i]); ++i, ++digits) out += t[i];
  if (i < t.size() && t[i] == '.') {
    out += digits == 0 ? "0." : ".";
    for (++i; i < t.size() && isDigit(t[i]); ++i, ++digits) out += t[i];
  }
  if (digits == 0) return "";
  if (i == t.size()) return out;
  const char e = static_cast<char>(std::toupper(static_cast<unsigned char>(t[i])));
  const bool letter = e == 'E' || e == 'D';
  if (letter) ++i;
  else if (t[i] != '+' && t[i] != '-') return "";
  out += 'e';
  if (i < t.size() && (t[i] == '+' || t[i] == '-')) out += t[i++];
  if (i == t.size()) return "";
  for (; i < t.size(); ++i) {
    if (!isDigit(t[i])) return "";
    out += t[i];
  }
  return out;
}

[[noreturn]] void refuse(const Line& line, const Field& field, std::string_view found, int column) {
  const Location where = line.at(column);
  const std::string name = field.name + " (columns " + std::to_string(field.first) + "-" + std::to_string(field.last) + ")";
  std::string lower(found);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (found.find('*') != std::string_view::npos)
    throw UserError(where, "asterisks for " + name + ": the value did not fit its columns", "a number", "run MODTRAN again so that every value fits");
  if (lower.find("nan") != std::string::npos || lower.find("inf") != std::string::npos)
    throw UserError(where, inQuotes(found) + " for " + name, "a finite number", "run MODTRAN again with an input that gives one");
  if (std::count(found.begin(), found.end(), '.') > 1)
    throw UserError(where, "two decimal points in " + name + ": numbers run together, " + inQuotes(found), "one number", kUnchanged);
  if (found.find_first_of(" \t") != std::string_view::npos)
    throw UserError(where, "two things in " + name + ": " + inQuotes(found) + ", so the columns are shifted", "one number at their right edge", kUnchanged);
  throw UserError(where, inQuotes(found) + " is not a number for " + name, "a number", kUnchanged);
}

}  // namespace

std::string_view trim(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::string inQuotes(std::string_view text) { return tokenOf(text); }

std::string_view Line::cut(int first, int last) const {
  const size_t from = static_cast<size_t>(first - 1);
  if (first > last || from >= text.size()) return {};
  return text.substr(from, static_cast<size_t>(last - first + 1));
}

std::string_view Line::trimmed() const { return trim(text); }

std::optional<double> numberIn(const Line& line, const Field& field) {
  const std::string_view whole = line.cut(field.first, field.last), found = trim(whole);
  if (found.empty()) return std::nullopt;
  const int column = field.first + static_cast<int>(found.data() - whole.data());
  const std::string plain = plainNumber(found);
  if (plain.empty()) refuse(line, field, found, column);
  double value = 0.0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (error == std::errc::result_out_of_range) {
    const size_t e = plain.find("e-");
    if (e == std::string::npos) throw UserError(line.at(column), inQuotes(found) + " for " + field.name + " is too large", "a finite number", kUnchanged);
    value = 0.0;  // smaller than the smallest double
  } else if (error != std::errc() || end != plain.data() + plain.size()) {
    refuse(line, field, found, column);
  }
  const int last = column + static_cast<int>(found.size()) - 1;
  if (last != field.last)
    throw UserError(line.at(column), inQuotes(found) + " for " + field.name + " ends at column " + std::to_string(last) + ", so the columns are shifted or cut",
                    "its end at column " + std::to_string(field.last), kUnchanged);
  return value;
}

std::optional<int> integerIn(const Line& line, const Field& field) {
  const auto value = numberIn(line, field);
  if (!value) return std::nullopt;
  if (*value != std::floor(*value) || std::abs(*value) > 1e9)
    throw UserError(line.at(field.first), inQuotes(line.cut(field.first, field.last)) + " for " + field.name + " is not a whole number", "a whole number",
                    kUnchanged);
  return static_cast<int>(*value);
}

std::vector<Line> linesOf(std::string_view text, const std::string& file) {
  if (!text.empty() && text.back() == '\x1a') text.remove_suffix(1);  // DOS marked a text's end so
  std::vector<Line> lines;
  int number = 0;
  while (!text.empty()) {
    const size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back({line, &file, ++number});
    for (size_t i = 0; i < line.size(); ++i) {
      const unsigned char c = static_cast<unsigned char>(line[i]);
      if (c == '\t')
        throw UserError(lines.back().at(static_cast<int>(i) + 1), "a tab, which hides where the columns are", "blanks as MODTRAN writes them", kUnchanged);
      if (c < 32 || c == 127)
        throw UserError(lines.back().at(static_cast<int>(i) + 1), "byte " + std::to_string(c) + " is not text", "a tape7 in text",
                        "run MODTRAN with BINARY = F (card 1, column 3)");
    }
  }
  if (std::all_of(lines.begin(), lines.end(), [](const Line& l) { return l.trimmed().empty(); }))
    throw UserError({file, 1, 1, -1}, "the file is empty", "a tape7 of MODTRAN", "copy it again, or run MODTRAN again");
  return lines;
}

}  // namespace pitviper::tape7
