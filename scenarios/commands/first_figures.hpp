#pragma once
// What a scenario takes from its file to its first picture and for the pictures after it, as named figures.
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace pitviper {

/// What a figure is of, which says how it is compared between machines.
enum class FigureKind {
  Seconds,  ///< of the clock
  Work,     ///< processor seconds, all threads together
  Frame,    ///< of the clock, of a picture [ms]
  Count     ///< the same on every machine, or nearly
};

struct FigureName {
  const char* name;
  FigureKind kind;
  const char* meaning;
};

/// All that a scenario's state has.
const std::vector<FigureName>& firstFigureNames();

/// By name; those that could not be found are missing.
using FirstFigures = std::map<std::string, double>;

/// A line each, "figure NAME VALUE", and back out of a text with other lines in it.
std::string writeFigures(const FirstFigures& figures);
FirstFigures readFigures(std::string_view text);

}  // namespace pitviper
