#pragma once
// What measureFirst() found, as tables and as CSV.
#include "scenarios/commands/first_bench.hpp"

namespace pitviper {

struct FirstRow {
  std::string scenario;  ///< its file
  std::vector<FirstState> states;
};

/// A row a state: where the time to the first picture went, and what the pictures after it took.
std::string firstTable(const FirstRow& row);
/// A row a scenario, a column a state: seconds to the first picture.
std::string firstSummary(const std::vector<FirstRow>& rows, const std::vector<std::string>& states);
/// A line a state, a column a figure.
std::string firstCsv(const std::vector<FirstRow>& rows);

}  // namespace pitviper
