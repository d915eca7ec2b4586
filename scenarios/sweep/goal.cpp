#include "scenarios/sweep/goal.hpp"

#include <algorithm>

#include "sim/parameters/print.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

std::string_view trimmedGoal(std::string_view text) {
  constexpr const char* kBlanks = " \t";
  const auto first = text.find_first_not_of(kBlanks);
  return first == std::string_view::npos ? std::string_view() : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace

Goal parseGoal(std::string_view text, const Location& where) {
  const std::string shown = "'" + std::string(text.substr(0, 80)) + "'";
  const char* const expected = "'<measure> = <value>', such as 'snr = 5' or 'range = 5.2 km'";
  if (const auto sign = text.find_first_of("<>~!"); sign != std::string_view::npos)
    throw UserError(where, shown + " asks for '" + std::string(1, text[sign]) + "'", expected,
                    "write '=': what is found is where the measure crosses the value");
  if (std::count(text.begin(), text.end(), '=') != 1)
    throw UserError(where, shown + (text.find('=') == std::string_view::npos ? " has no '='" : " has more than one '='"), expected, "write one '='");
  const auto sign = text.find('=');
  Goal goal;
  goal.measure = trimmedGoal(text.substr(0, sign));
  const std::string_view value = trimmedGoal(text.substr(sign + 1));
  if (goal.measure.empty()) throw UserError(where, shown + " names no measure", expected, "write a measure of the sweep before the '='");
  const auto written = splitQuantity(value);
  if (!written) throw UserError(where, shown + " has no number behind the '='", expected, "write the value that the measure shall have");
  if (!parseUnit(written->unit))
    throw UserError(where, shown + ": '" + written->unit.substr(0, 40) + "' is no unit", "a unit such as km, K or W/sr, or none",
                    "write the measure's own unit");
  goal.value = written->value;
  goal.unit = written->unit;
  return goal;
}

}  // namespace pitviper
