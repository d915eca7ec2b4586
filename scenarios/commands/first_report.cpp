#include "scenarios/commands/first_report.hpp"

#include <algorithm>
#include <filesystem>

#include "scenarios/commands/print.hpp"

namespace pitviper {
namespace {

/// Empty where there is no such figure.
std::string number(const FirstState& state, const std::string& name, const char* format) {
  const auto found = state.figures.find(name);
  return found == state.figures.end() ? "" : print(format, found->second);
}

/// Of the clock, and of all processors together.
std::string seconds(const FirstState& state, const std::string& name) {
  return number(state, name, "%.2f") + " (" + number(state, name + "_work", "%.2f") + ")";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text) out += c == '"' ? "\"\"" : c == '\n' ? " " : std::string(1, c);
  return out + "\"";
}

std::string shortName(const std::string& scenario) { return std::filesystem::path(scenario).stem().string(); }

}  // namespace

std::string firstTable(const FirstRow& row) {
  std::string out = shortName(row.scenario) + ": s, in brackets processor s\n";
  out +=
      "| state | reading | planning | tables | programs | first frame | to a picture | programs: made, lines, compiled | groups | frame ms: 50 %, 99 %, most (which of) | MB | yardstick ms |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::string changes;
  for (const FirstState& s : row.states) {
    if (s.name != "first" && s.name != "second") changes += "  " + s.name + ": " + s.words + (s.measured ? "" : "; left out") + "\n";
    if (!s.measured) continue;
    out += "| " + s.name + " |";
    for (const char* stage : {"reading", "planning", "tables", "programs", "first_frame", "picture"}) out += " " + seconds(s, stage) + " |";
    out += " " + number(s, "programs_made", "%.0f") + ", " + number(s, "program_lines", "%.0f") + ", " + number(s, "compiled", "%.0f") + " | " + number(s, "groups", "%.0f") + " | " +
           number(s, "frame_50", "%.1f") + ", " + number(s, "frame_99", "%.1f") + ", " + number(s, "frame_most", "%.1f") + " (" + number(s, "frame_most_at", "%.0f of ") + number(s, "frames", "%.0f") + ") | " +
           number(s, "memory", "%.0f") + " | " + number(s, "yardstick", "%.1f") + " |\n";
  }
  return out + changes;
}

std::string firstSummary(const std::vector<FirstRow>& rows, const std::vector<std::string>& states) {
  std::string out = "Seconds to a picture, in brackets processor seconds\n| scenario |", line = "\n|---|";
  for (const std::string& state : states) out += " " + state + " |", line += "---|";
  out += " planning of first | MB |" + line + "---|---|\n";
  for (const FirstRow& row : rows) {
    out += "| " + shortName(row.scenario) + " |";
    for (const std::string& name : states) {
      const auto found = std::find_if(row.states.begin(), row.states.end(), [&](const FirstState& s) { return s.name == name && s.measured; });
      out += found == row.states.end() ? " - |" : " " + seconds(*found, "picture") + " |";
    }
    out += " " + seconds(row.states.front(), "planning") + " | " + number(row.states.front(), "memory", "%.0f") + " |\n";
  }
  return out;
}

std::string firstCsv(const std::vector<FirstRow>& rows) {
  std::string out = "scenario,state,words";
  for (const FigureName& f : firstFigureNames()) out += std::string(",") + f.name;
  out += "\n";
  for (const FirstRow& row : rows)
    for (const FirstState& s : row.states) {
      out += quoted(row.scenario) + "," + s.name + "," + quoted(s.words);
      for (const FigureName& f : firstFigureNames()) out += "," + number(s, f.name, "%.6g");
      out += "\n";
    }
  return out;
}

}  // namespace pitviper
