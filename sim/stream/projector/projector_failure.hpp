#pragma once
// Why there is no display.
#include <stdexcept>
#include <string>

namespace pitviper {

struct ProjectorFailure : std::runtime_error {
  ProjectorFailure(const std::string& wrong, std::string whatExpected, std::string whatToDo)
      : std::runtime_error(wrong), expected(std::move(whatExpected)), fix(std::move(whatToDo)) {}
  std::string expected, fix;
};

}  // namespace pitviper
