#include "scenarios/commands/guard_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "scenarios/commands/bench_factors.hpp"
#include "scenarios/commands/first_bench.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {
namespace {

constexpr std::uintmax_t kLargestFile = 1u << 20;
constexpr std::size_t kCells = 6;

struct Cell {
  std::string text;
  Location where;
};

/// As many as there are between commas; the last has all that is left.
std::vector<Cell> cellsOf(const std::string& line, const std::string& file, int number) {
  std::vector<Cell> cells;
  std::size_t from = 0;
  while (cells.size() < kCells && from <= line.size()) {
    const std::size_t comma = cells.size() + 1 < kCells ? line.find(',', from) : std::string::npos;
    const std::size_t end = comma == std::string::npos ? line.size() : comma;
    const std::size_t first = std::min(line.find_first_not_of(" \t", from), end);
    std::string text = line.substr(first, end - first);
    text.erase(text.find_last_not_of(" \t\r") + 1);
    cells.push_back({text, {file, number, static_cast<int>(first) + 1, -1}});
    from = end + 1;
  }
  return cells;
}

void expectOneOf(const Cell& cell, const std::string& what, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), cell.text) == names.end())
    throw UserError(cell.where, "there is no " + what + " '" + cell.text + "'", "one of " + listed(names), didYouMean(cell.text, names));
}

std::vector<std::string> figuresOfScenarios() {
  std::vector<std::string> names;
  for (const FigureName& f : firstFigureNames()) names.emplace_back(f.name);
  return names;
}

std::vector<std::string> statesOfBench() {
  std::vector<std::string> names;
  for (const BenchFactor& f : benchFactors())
    for (const BenchVariant& v : f.variants) names.push_back(f.name + "/" + v.value + "/" + v.mode);
  return names;
}

double valueOf(const Cell& cell) {
  double value = 0.0;
  const char* const end = cell.text.data() + cell.text.size();
  const auto [last, error] = std::from_chars(cell.text.data(), end, value);
  if (error != std::errc() || last != end || !std::isfinite(value) || value < 0.0)
    throw UserError(cell.where, "'" + cell.text + "' is no value of a figure", "a number, 0 or more, without a unit",
                    "write what bench --guard prints as 'now'");
  return value;
}

GuardLine lineOf(const std::vector<Cell>& cells, const std::filesystem::path& folder) {
  const auto &set = cells[0], &subject = cells[1], &state = cells[2], &figure = cells[3], &reason = cells[5];
  expectOneOf(set, "set", {"quick", "all"});
  GuardLine line;
  line.where = subject.where;
  line.quick = set.text == "quick";
  line.name = subject.text;
  line.state = state.text;
  line.figure = figure.text;
  line.reason = reason.text;
  std::error_code ignored;
  line.path = (folder / subject.text).lexically_normal();
  if (subject.text == kBenchSubject) {
    line.subject = GuardSubject::Bench;
    expectOneOf(state, "row of bench", statesOfBench());
    expectOneOf(figure, "figure of bench", {kByYardstickFigure});
  } else if (std::filesystem::is_directory(line.path, ignored)) {
    line.subject = GuardSubject::Folder;
    if (!state.text.empty()) throw UserError(state.where, "a folder of sources has no state", "nothing between these commas", "remove it");
    expectOneOf(figure, "figure of a folder", {kLinesFigure});
  } else if (std::filesystem::is_regular_file(line.path, ignored)) {
    expectOneOf(state, "state of a scenario", firstStateNames());
    expectOneOf(figure, "figure of a scenario", figuresOfScenarios());
  } else {
    throw UserError(subject.where, "there is neither a file nor a folder '" + subject.text + "'",
                    "a scenario or a folder of sources, from this file's own folder, or 'bench'", "check the name");
  }
  line.value = valueOf(cells[4]);
  if (reason.text.empty())
    throw UserError(reason.where, "the figure has no reason", "in the last column why it may be so large", "say when and why it was written so");
  return line;
}

}  // namespace

std::vector<GuardLine> readGuardFile(const std::filesystem::path& file) {
  std::istringstream in(readWholeFile(file, {.what = "a file of figures", .mostBytes = kLargestFile}, {file.string(), 0, 0, -1}));
  std::vector<GuardLine> lines;
  std::set<std::string> labels;
  int number = 0;
  for (std::string text; std::getline(in, text);) {
    ++number;
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos || text[first] == '#') continue;
    const auto cells = cellsOf(text, file.string(), number);
    if (cells.size() != kCells)
      throw UserError({file.string(), number, 1, -1}, std::to_string(cells.size()) + " cells", "6: set, subject, state, figure, value, reason",
                      "add what is missing between commas");
    lines.push_back(lineOf(cells, file.parent_path()));
    if (!labels.insert(lines.back().label()).second)
      throw UserError(lines.back().where, "the figure '" + lines.back().label() + "' is there twice", "each once", "remove one");
  }
  return lines;
}

}  // namespace pitviper
