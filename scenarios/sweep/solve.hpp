#pragma once
// Where a measure that is noisy has a value: what `pitviper sweep --solve` and Python ask for.
//
// Law: bisection. The side of a place is that of the mean of its repeats, once Student's t tells it from the target: looked at after 4, 8, 16 ... repeats, each
//   look with its part of the 5 % (Bonferroni). Where all that are allowed do not tell it, the crossing is near: it is closed in from both sides as far as
//   sides can be told. Then three places about it are drawn anew, for draws so far ended when they did because of what they were: twice the repeats at the
//   middle one, half of them at the two beside it, which give the slope. Where the line meets the target is x, and the interval is Fieller's: noise over slope
//   where the slope is sure.
// Source: Student 1908; Fieller 1954, J. R. Stat. Soc. B 16, 175; Welch 1947, Biometrika 34, 28 (degrees of freedom).
// Valid: a mean that crosses the target once in the range, with a slope there. Where it bends so much between the three places that the line is off by more
//   than its noise the interval holds all three. Of a measure of two values (seen or not) with 64 repeats the interval holds the crossing of 1/2 and of 0.8 as
//   it should, that of 0.95 in nine cases of ten.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// A measure at x; another seed is another draw of its noise, the same seed the same.
using SeededMeasure = std::function<double(double x, std::uint64_t seed)>;

struct SolveWish {
  double target = 0.0;
  double low = 0.0, high = 0.0;                       ///< of x
  bool logarithmic = false;                           ///< x by ratios: both ends above 0
  int repeats = 16;                                   ///< at most at a place, but for the last three; 4 or more
  double tolerance = 1e-3;                            ///< of the range (of its logarithm): no finer is bisected
  std::uint64_t seed = 0;                             ///< all of the result follows from it
  std::string factor = "x", measure = "the measure";  ///< for messages
  Location where = {"--solve", 0, 0, -1};
};

struct SolveTry {
  double x = 0.0, mean = 0.0;
  double standardError = 0.0;  ///< of the mean; 0: one draw, or all alike
  int repeats = 0;
};

struct Solution {
  double x = 0.0;
  /// Hold the crossing in 95 % of all cases, cut off at the range's ends; of a measure without noise the places that it lies between.
  double low95 = 0.0, high95 = 0.0;
  bool isNoisy = false;
  int evaluations = 0;
  std::vector<SolveTry> tried;  ///< in their order
};

/// Where the mean of a measure crosses the target. A measure whose two draws are equal at both ends is taken to have no noise and drawn once a place; the two
/// that the crossing lies between are drawn again at last (to six draws each where the measure has few values), and where they differ all begins anew with
/// noise. Errors: UserError for a wish that cannot be; where the means at both ends are on one side of the target, with these; where the measure is not a
/// number.
Solution solve(const SeededMeasure& measure, const SolveWish& wish);

}  // namespace pitviper
