#pragma once
// Where values lie along an axis, and what is written beside it.
#include <string>
#include <vector>

#include "scenarios/sweep/sweep.hpp"

namespace pitviper {

struct SweepAxis {
  struct Tick {
    double at = 0.0;  ///< as place()
    std::string label;
  };
  double low = 0.0, high = 1.0;  ///< its ends; logarithms to base 10 where it is logarithmic
  bool isLogarithmic = false;
  std::vector<Tick> ticks;
  std::string power;  ///< "×10³": labels are to be multiplied by it

  /// From 0 to 1; outside for what is beyond its ends, NaN for what it has no place for.
  double place(double value) const;
};

/// Holds all finite values with a margin: logarithmic where they are above 0 and crowd at the low end of two decades or more. Of no finite values, or of some
/// too far apart for a double, it has no ticks and nothing has a place.
SweepAxis axisHolding(const std::vector<double>& values);

/// From `low` to `high` as they are. Needs finite low < high.
SweepAxis plainAxis(double low, double high);

/// Words side by side, at 0, 1, ...; each cut to its part of the `characters` that have room.
SweepAxis axisOfWords(const SweepFactor& choice, std::size_t characters);

}  // namespace pitviper
