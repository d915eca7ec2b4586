#pragma once
// Round numbers along an axis.
#include <string>
#include <vector>

namespace pitviper {

/// Ticks at multiples of 1, 2 or 5 times a power of ten, inside the range. A label times 10^power is the value.
struct Ticks {
  std::vector<double> values;
  std::vector<std::string> labels;
  int power = 0;  ///< 0 where plain numbers are readable
};

/// Three to eight ticks in [low, high], 5 or 6 where the steps permit. Needs finite low < high, else std::invalid_argument.
Ticks chooseTicks(double low, double high);

/// "×10⁻³", or nothing for 0.
std::string powerText(int power);

/// A value alone, in four digits: "305.2", "4.1e2" style ("4.1e-7") below 0.001 and from 100000.
std::string shortNumber(double value);

}  // namespace pitviper
