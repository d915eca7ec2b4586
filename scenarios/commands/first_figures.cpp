#include "scenarios/commands/first_figures.hpp"

#include <sstream>

#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

constexpr const char* kMark = "figure ";

}  // namespace

const std::vector<FigureName>& firstFigureNames() {
  using enum FigureKind;
  static const std::vector<FigureName> all{
      {"reading", Seconds, "the scenario with all its files"},
      {"reading_work", Work, "of the same"},
      {"planning", Seconds, "plans of all cameras, made or found again"},
      {"planning_work", Work, "of the same"},
      {"tables", Seconds, "all other preparing before the first frame"},
      {"tables_work", Work, "of the same"},
      {"programs", Seconds, "compiling and linking; what a driver leaves for the first use of a program is in first_frame"},
      {"programs_work", Work, "of the same"},
      {"first_frame", Seconds, "a frame of every camera, with what is made once for it"},
      {"first_frame_work", Work, "of the same"},
      {"picture", Seconds, "all of it: from the start of the program to the first picture"},
      {"picture_work", Work, "of the same"},
      {"frame_50", Frame, "a frame of every camera after the first: the 50th percentile [ms]"},
      {"frame_99", Frame, "the 99th [ms]"},
      {"frame_most", Frame, "the longest [ms]"},
      {"frame_most_at", Count, "which of them that is, from 1 for the second picture"},
      {"frame_work", Work, "processor seconds of one of them: median"},
      {"frame_own", Frame, "the processor's own time of one of them, without drawing: median [ms]"},
      {"frames", Count, "so many of them"},
      {"groups", Count, "wavelengths or groups of them, all cameras together"},
      {"programs_made", Count, "programs, up to the first picture"},
      {"program_lines", Count, "lines of their texts"},
      {"programs_later", Count, "programs made in frames after the first"},
      {"compiled", Count, "files that the driver's cache of programs gained"},
      {"memory", Count, "most that it had, resident [MB]"},
      {"yardstick", Frame, "a frame of the yardstick, meanwhile [ms]"},
      {"yardstick_work", Work, "processor seconds of a frame of the yardstick; none where it is drawn elsewhere"},
  };
  return all;
}

std::string writeFigures(const FirstFigures& figures) {
  std::string text;
  for (const auto& [name, value] : figures) text += kMark + name + print(" %.9g\n", value);
  return text;
}

FirstFigures readFigures(std::string_view text) {
  FirstFigures figures;
  std::istringstream in{std::string(text)};
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(kMark)) continue;
    std::istringstream words(line.substr(std::string_view(kMark).size()));
    std::string name;
    double value = 0.0;
    if (words >> name >> value) figures[name] = value;
  }
  return figures;
}

}  // namespace pitviper
