#pragma once
// A sweep: a scenario drawn again and again with some of its keys at other values, and what is measured of each picture.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// What varies. Its values are numbers in `unit`; of a choice the place of its word among `choices`, from 0.
struct SweepFactor {
  std::string name;
  std::string unit;  ///< as the sweep's file has it: "km"; empty: dimensionless
  std::vector<std::string> choices = {};
};

/// One draw of all factors: the same whether it is drawn alone or among all.
struct Sample {
  int number = 0;  ///< from 0
  std::uint64_t seed = 0;
  std::vector<double> values;     ///< by factor
  std::vector<std::string> sets;  ///< "path.to.key=value", as --set has them
};

/// A number, or several of a Python function, that each sample gives.
struct Measure {
  enum class Kind { Truth, Statistic, Python, Expected };  ///< Expected: what every sweep has, last
  Location where;
  Kind kind = Kind::Statistic;
  std::vector<std::string> names;  ///< of its columns; one, but of a Python function
  std::vector<std::string> units;  ///< of these; those of Python as told there, of others empty until a frame tells
  std::string camera;              ///< empty: the first
  std::string target, value;       ///< Truth: name of a row of the frame's targets, and a column of the truth table ("range [m]" is asked for as "range")
  std::string layer, statistic;    ///< Statistic: "mw.radiance"; mean, sigma, min, max, median, sum, p99.5
  std::vector<int> region;         ///< Statistic: left, top, width, height [pixels]; empty: the whole film
  std::filesystem::path file;      ///< Python
  std::string function;
};

/// What a sweep gave for one sample.
struct SweepRow {
  int sample = 0;
  std::uint64_t seed = 0;
  std::vector<double> factors, measures;  ///< a measure that a picture does not have is NaN
  std::string why;                        ///< why there are no measures; empty: there are
};

}  // namespace pitviper
