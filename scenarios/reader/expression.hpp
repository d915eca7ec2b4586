#pragma once
// Values that are worked out: "= 2 * $speed * 3 s".
#include <functional>
#include <string>
#include <string_view>

#include "sim/parameters/error.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {

/// A parameter as a number with unit; throws UserError where there is no such parameter, or it is no number.
using NumberNamed = std::function<WrittenQuantity(std::string_view name)>;

/// `text` without its leading '=': numbers with units, $name and ${name}, + - * / ( ), min, max, abs, floor, mod (never negative for a divisor above 0), sqrt,
/// sin, cos, tan (of angles) and pi. Units are checked by their dimensions; a temperature in degC counts from absolute zero. The result is a number with a unit
/// as scenarios have them, in the unit of its first term where that serves, else in W, m, s, K, rad, sr, V, count and lm. Errors: UserError at `where` for what
/// is no expression, units that do not fit, division by 0 and what is not finite.
std::string evaluate(std::string_view text, const Location& where, const NumberNamed& named);

/// A number as scenarios have it: whole ones without an exponent, others with as many digits as bring back the same double.
std::string numberText(double value);

/// Length of a parameter's name at the front of a text: letters, digits and '_', no digit first; 0 where there is none.
std::size_t nameLength(std::string_view text);

}  // namespace pitviper
