#pragma once
// What a sweep is to find: a measure and the value that it shall have.
#include <string>
#include <string_view>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// "snr = 5", "range = 5.2 km".
struct Goal {
  std::string measure;  ///< as the sweep names it
  double value = 0.0;   ///< in `unit`
  std::string unit;     ///< as written; empty: none was
};

/// Errors: UserError at `where` for a text that is no measure, one '=' and a number with or without a unit that is known.
Goal parseGoal(std::string_view text, const Location& where = {"--solve", 0, 0, -1});

}  // namespace pitviper
