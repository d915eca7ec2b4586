#pragma once
// Units as written in scenarios: "3.5 um", "62 degC", "0.2 /km", "1361 W/m2", "12 kW/sr".
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace pitviper {

/// Exponents over {watt, metre, second, kelvin, radian, steradian, volt, count, lumen} and a factor to those units.
/// Wavelength is a length: "um" is 1e-6 m, so W/(m2 sr um) is W m^-3 sr^-1 with factor 1e6.
struct Unit {
  std::array<int, 9> dims{};
  double factor = 1.0;
  double offset = 0.0;  ///< added before the factor; only a lone degC or degF has one
};

/// Reads a unit expression: names with optional integer exponent, joined by '*', '/', '.' or blanks, with parentheses.
/// Empty, "1" and "-" are dimensionless; "/km" is 1/km. Returns nothing where a name is unknown.
std::optional<Unit> parseUnit(std::string_view text);

/// A number with the unit written behind it. Unit text is empty where none is written.
struct WrittenQuantity {
  double value = 0.0;
  std::string unit;
};

/// Splits "3.5 um" into number and unit; nothing where it does not begin with a finite decimal number.
std::optional<WrittenQuantity> splitQuantity(std::string_view text);

/// Converts to `canonical` (a unit expression such as "W/(m2 sr um)"). Nothing where the dimensions differ.
std::optional<double> convert(const WrittenQuantity& quantity, std::string_view canonical);

/// What to write for a unit, for messages: examples for well-known canonical units.
std::string unitExample(std::string_view canonical);

}  // namespace pitviper
