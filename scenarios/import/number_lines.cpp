#include "scenarios/import/number_lines.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "sim/parameters/readable_text.hpp"

namespace pitviper {
namespace {

constexpr std::array kStyles = {CellStyle::Blanks, CellStyle::Semicolons, CellStyle::Commas, CellStyle::BlanksDecimalComma, CellStyle::SemicolonsDecimalComma};
using Possible = std::array<bool, kStyles.size()>;

bool decimalComma(CellStyle s) { return s == CellStyle::BlanksDecimalComma || s == CellStyle::SemicolonsDecimalComma; }

std::optional<double> numberIn(std::string_view cell, CellStyle style) {
  std::string text(cell);
  if (decimalComma(style)) {
    if (text.find('.') != std::string::npos) return std::nullopt;
    std::replace(text.begin(), text.end(), ',', '.');
  }
  const char* begin = text.data() + (!text.empty() && text.front() == '+' ? 1 : 0);
  double value = 0.0;
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::vector<double>> numbersIn(std::string_view line, CellStyle style) {
  std::vector<double> all;
  auto cells = cellsOf(line, style);
  // A separator may end the line.
  if (cells.size() > 1 && cells.back().empty()) cells.pop_back();
  for (std::string_view cell : cells) {
    const auto v = numberIn(cell, style);
    if (!v) return std::nullopt;
    all.push_back(*v);
  }
  if (all.empty()) return std::nullopt;
  return all;
}

std::string lowered(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// "#DATA", "data=", "[Data]", ">>>>>Begin Spectral Data<<<<<".
bool isBeginMark(std::string_view line) {
  const std::string low = lowered(line);
  if (low.find("begin") != std::string::npos && low.find("data") != std::string::npos) return true;
  std::string letters;
  for (char c : low)
    if (std::isalnum(static_cast<unsigned char>(c))) letters += c;
  return letters == "data" && low.find_first_of("#[=:>*") != std::string::npos;
}

bool isEndMark(std::string_view line) {
  const std::string low = lowered(line);
  const std::size_t first = low.find_first_not_of("#>*[ \t");
  return first != std::string::npos && low.compare(first, 3, "end") == 0 &&
         (low.size() == first + 3 || !std::isalnum(static_cast<unsigned char>(low[first + 3])) || first > 0);
}

/// A number such as 1,234: a group of thousands, or a decimal.
bool maybeThousands(std::string_view cell) {
  const std::size_t comma = cell.find(',');
  if (comma == std::string_view::npos || comma == 0 || comma > 3 || cell.size() != comma + 4 || cell.front() == '0') return false;
  return std::all_of(cell.begin(), cell.end(), [](char c) { return c == ',' || (c >= '0' && c <= '9'); });
}

std::vector<std::string_view> linesOf(const std::string& text) {
  std::vector<std::string_view> lines;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    lines.push_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return lines;
}

bool isBlank(std::string_view line) { return line.find_first_not_of(" \t") == std::string_view::npos; }

/// Narrows down what the styles can be to those in which the line is of `columns` numbers (0: two at least).
bool narrow(std::string_view line, std::size_t columns, Possible& possible) {
  Possible after{};
  for (std::size_t s = 0; s < kStyles.size(); ++s) {
    if (!possible[s]) continue;
    const auto v = numbersIn(line, kStyles[s]);
    after[s] = v && (columns ? v->size() == columns : v->size() > 1);
  }
  if (std::none_of(after.begin(), after.end(), [](bool b) { return b; })) return false;
  possible = after;
  return true;
}

}  // namespace

std::vector<std::string_view> cellsOf(std::string_view line, CellStyle style) {
  const bool blanks = style == CellStyle::Blanks || style == CellStyle::BlanksDecimalComma;
  std::vector<std::string_view> all;
  const auto add = [&](std::string_view cell) {
    while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t')) cell.remove_suffix(1);
    if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
    if (!blanks || !cell.empty()) all.push_back(cell);
  };
  const char* separators = blanks ? " \t" : style == CellStyle::Commas ? "," : ";";
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
    add(line.substr(at, end - at));
    at = end + 1;
  }
  return all;
}

std::string asUtf8Lines(const std::string& text, const std::string& file) {
  std::string_view rest = text;
  if (rest.substr(0, 3) == "\xEF\xBB\xBF") rest.remove_prefix(3);
  if (rest.substr(0, 2) == "\xFF\xFE" || rest.substr(0, 2) == "\xFE\xFF" || rest.substr(0, 256).find('\0') != std::string_view::npos)
    throw UserError({file, 1, 1, -1}, "the file is no text in UTF-8", "lines of words and numbers", "save it as text in UTF-8");
  std::string out;
  out.reserve(rest.size());
  while (!rest.empty()) {
    const std::size_t length = utf8Length(rest);
    if (rest.front() == '\r') {
      out += '\n';
      rest.remove_prefix(rest.size() > 1 && rest[1] == '\n' ? 2 : 1);
    } else if (length > 0) {
      out += rest.substr(0, length);
      rest.remove_prefix(length);
    } else {
      const auto byte = static_cast<unsigned char>(rest.front());
      out += static_cast<char>(0xc0 | byte >> 6);
      out += static_cast<char>(0x80 | (byte & 0x3f));
      rest.remove_prefix(1);
    }
  }
  return out;
}

NumberLines readNumberLines(const std::string& text, const std::string& file) {
  const auto lines = linesOf(text);
  NumberLines all;
  Possible possible;
  possible.fill(true);
  const auto mark = std::find_if(lines.begin(), lines.end(), isBeginMark);
  const auto from = mark == lines.end() ? lines.begin() : mark + 1;
  // Two numbers at least; a file of one column has none such.
  const auto pair = std::find_if(from, lines.end(), [&](std::string_view line) {
    Possible own = possible;
    return narrow(line, 0, own);
  });
  const bool single = pair == lines.end();
  const auto begin = !single ? pair : std::find_if(from, lines.end(), [](std::string_view line) { return numbersIn(line, CellStyle::Blanks).has_value(); });
  for (auto l = lines.begin(); l != begin; ++l) all.head.emplace_back(*l);
  std::vector<std::pair<std::string_view, int>> body;
  for (auto l = begin; l != lines.end(); ++l) {
    const Location where{file, static_cast<int>(l - lines.begin()) + 1, 1, -1};
    if (isBlank(*l)) continue;
    if (isEndMark(*l)) break;
    Possible own = possible;
    if (!narrow(*l, single ? 1 : 0, own)) {
      const bool comma = l->find(',') != std::string_view::npos;
      throw UserError(
          where, "among the numbers a line that is none: " + tokenOf(*l),
          comma ? "numbers in the form of the rows above it; a comma is a decimal point or parts cells, the same all through" : "numbers, as above it",
          "correct the line; remove it if it does not belong to the spectrum");
    }
    possible = own;
    body.emplace_back(*l, where.line);
  }
  if (body.empty()) return all;
  std::vector<std::size_t> left;
  for (std::size_t s = 0; s < kStyles.size(); ++s)
    if (possible[s]) left.push_back(s);
  const auto read = [&](CellStyle style) {
    std::vector<NumberRow> rows;
    for (const auto& [line, number] : body) rows.push_back({*numbersIn(line, style), number});
    return rows;
  };
  all.style = kStyles[left.front()];
  all.rows = read(all.style);
  for (std::size_t k = 1; k < left.size(); ++k) {
    const auto other = read(kStyles[left[k]]);
    for (std::size_t r = 0; r < other.size(); ++r)
      if (other[r].values != all.rows[r].values)
        throw UserError({file, other[r].line, 1, -1}, "the commas of this row part cells or are decimal points", "one or the other",
                        "write semicolons or blanks between cells, and points for decimals");
  }
  for (const NumberRow& row : all.rows)
    if (row.values.size() != all.rows.front().values.size())
      throw UserError({file, row.line, 1, -1}, "a row of " + std::to_string(row.values.size()) + " numbers",
                      std::to_string(all.rows.front().values.size()) + ", as the first row has", "fill the hole, or remove the row");
  if (decimalComma(all.style)) {
    bool commas = false, thousands = true;
    for (const auto& [line, number] : body)
      for (std::string_view cell : cellsOf(line, all.style))
        if (cell.find(',') != std::string_view::npos) commas = true, thousands = thousands && maybeThousands(cell);
    if (commas && thousands)
      throw UserError({file, body.front().second, 1, -1}, "commas that are decimal points or part groups of thousands", "numbers that can be read in one way",
                      "write points for decimals, and no groups");
  }
  return all;
}

}  // namespace pitviper
