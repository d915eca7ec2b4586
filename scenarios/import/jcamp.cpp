#include "scenarios/import/jcamp.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "sim/parameters/readable_text.hpp"

namespace pitviper {
namespace {

/// What stands behind a label, and where.
struct Labelled {
  std::string value;
  int line = 0;
};

/// Letters alone, in capitals: labels are alike whatever stands between their letters.
std::string labelOf(std::string_view text) {
  std::string out;
  for (char c : text)
    if (std::isalnum(static_cast<unsigned char>(c))) out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return out;
}

/// Numbers one after the other, parted by blanks, commas, semicolons or their signs.
std::vector<double> numbersOf(std::string_view line, const Location& where) {
  std::vector<double> all;
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t,;", at)) != std::string_view::npos;) {
    const std::size_t begin = at + (line[at] == '+' ? 1 : 0);
    double value = 0.0;
    const auto [end, error] = std::from_chars(line.data() + begin, line.data() + line.size(), value);
    const std::size_t next = static_cast<std::size_t>(end - line.data());
    const bool parted = next >= line.size() || std::string_view(" \t,;+-").find(line[next]) != std::string_view::npos;
    if (error != std::errc() || !std::isfinite(value) || !parted)
      throw UserError({where.file, where.line, static_cast<int>(at) + 1, -1}, "not a number: " + tokenOf(line.substr(at)), "numbers as they are (AFFN)",
                      "export the spectrum without packing (no SQZ, DIF or DUP)");
    all.push_back(value);
    at = next;
  }
  return all;
}

}  // namespace

bool isJcamp(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\n");
  return first != std::string::npos && text.compare(first, 2, "##") == 0 && text.substr(first, 200).find('=') != std::string::npos;
}

NumberLines readJcamp(const std::string& text, const std::string& file) {
  NumberLines all;
  std::map<std::string, Labelled> records;
  std::istringstream in(text);
  std::string form;
  Location where{file, 0, 1, -1};
  std::vector<std::pair<std::vector<double>, int>> body;
  bool inData = false, ended = false;
  for (std::string line; !ended && std::getline(in, line);) {
    ++where.line;
    if (const std::size_t remark = line.find("$$"); remark != std::string::npos) line.resize(remark);
    if (line.rfind("##", 0) == 0) {
      inData = false;
      const std::size_t equals = line.find('=');
      if (equals == std::string::npos) continue;
      const std::string label = labelOf(line.substr(2, equals - 2));
      ended = label == "END";
      std::string value = line.substr(equals + 1);
      if (label == "XYDATA" || label == "XYPOINTS" || label == "PEAKTABLE") {
        if (!form.empty()) throw UserError(where, "a second spectrum in the file", "one", "split the file");
        form = labelOf(value);
        inData = true;
        all.head.emplace_back();
      } else {
        records[label] = {value, where.line};
        all.head.push_back(line.substr(2));
      }
      continue;
    }
    if (inData) {
      auto numbers = numbersOf(line, where);
      if (!numbers.empty()) body.emplace_back(std::move(numbers), where.line);
    } else {
      all.head.emplace_back();
    }
  }
  if (body.empty())
    throw UserError({file, 1, 1, -1}, "a JCAMP-DX file without data", "##XYDATA= or ##XYPOINTS= and rows of numbers", "export the spectrum again");
  const auto number = [&](const char* label) -> std::optional<double> {
    const auto found = records.find(label);
    if (found == records.end()) return std::nullopt;
    const auto v = numbersOf(found->second.value, {file, found->second.line, 1, -1});
    return v.size() == 1 ? std::optional(v[0]) : std::nullopt;
  };
  const double xFactor = number("XFACTOR").value_or(1.0), yFactor = number("YFACTOR").value_or(1.0);
  if (form == "XYXY") {
    for (const auto& [numbers, line] : body) {
      if (numbers.size() % 2)
        throw UserError({file, line, 1, -1}, "a row of " + std::to_string(numbers.size()) + " numbers", "pairs of x and y", "complete the last pair");
      for (std::size_t k = 0; k < numbers.size(); k += 2) all.rows.push_back({{numbers[k] * xFactor, numbers[k + 1] * yFactor}, line});
    }
  } else if (form == "XYY") {
    const auto first = number("FIRSTX"), last = number("LASTX"), points = number("NPOINTS");
    if (!first || !last || !points || !(*points >= 2.0))
      throw UserError({file, body.front().second, 1, -1}, "data as (X++(Y..Y)) without ##FIRSTX=, ##LASTX= and ##NPOINTS=", "all three",
                      "export the spectrum again");
    const double step = (*last - *first) / (*points - 1.0);
    for (const auto& [numbers, line] : body) {
      const double at = *first + step * static_cast<double>(all.rows.size());
      if (!(std::abs(numbers[0] * xFactor - at) <= 0.5 * std::abs(step)))
        throw UserError({file, line, 1, -1}, "a row that begins at x = " + tokenOf(std::to_string(numbers[0] * xFactor)),
                        "x = " + std::to_string(at) + ", where FIRSTX, LASTX and NPOINTS put it", "export the spectrum again");
      for (std::size_t k = 1; k < numbers.size(); ++k) all.rows.push_back({{*first + step * static_cast<double>(all.rows.size()), numbers[k] * yFactor}, line});
    }
  } else {
    throw UserError({file, body.front().second, 1, -1}, "data in the form " + tokenOf(form), "(XY..XY) or (X++(Y..Y))", "export the spectrum again");
  }
  if (const auto points = number("NPOINTS"); points && static_cast<double>(all.rows.size()) != *points)
    throw UserError({file, records["NPOINTS"].line, 1, -1}, std::to_string(all.rows.size()) + " points in the file", "as many as ##NPOINTS= says",
                    "copy the whole file again");
  return all;
}

}  // namespace pitviper
