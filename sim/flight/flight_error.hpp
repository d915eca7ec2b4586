#pragma once
// What a user asked of a flight that it cannot do. It names the key of a scenario that is wrong, so that a reader can add file, line and column.
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

namespace pitviper {

class FlightError : public std::runtime_error {
 public:
  FlightError(std::string itsOption, std::string isWrong, std::string isExpected, std::string itsFix, std::optional<std::size_t> itsItem = {})
      : std::runtime_error(itsOption + (itsItem ? " " + std::to_string(*itsItem + 1) : "") + ": " + isWrong + "; expected " + isExpected + "; fix: " + itsFix),
        option(std::move(itsOption)),
        wrong(std::move(isWrong)),
        expected(std::move(isExpected)),
        fix(std::move(itsFix)),
        item(itsItem) {}

  std::string option, wrong, expected, fix;
  std::optional<std::size_t> item;  ///< of a list, from 0
};

/// Throws what is wrong with an option's value unless it is good.
inline void checkFlight(bool good, const char* option, double value, const char* expected, const char* fix) {
  if (!good) throw FlightError(option, std::to_string(value), expected, fix);
}

}  // namespace pitviper
