#pragma once
// What a call refuses, as text.
#include <string>

#include "sim/parameters/error.hpp"

namespace pitviper::test {

/// The message of the UserError that it throws; empty: it throws none.
template <class Call>
std::string refusalOf(const Call& call) {
  try {
    call();
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

inline bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace pitviper::test
