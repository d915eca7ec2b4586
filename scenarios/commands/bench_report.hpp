#pragma once
// What `bench` found: tables for a terminal or a README, CSV for machines, charts for people.
#include <string>
#include <vector>

#include "scenarios/commands/bench_timing.hpp"
#include "scenarios/commands/charts.hpp"

namespace pitviper {

/// Markdown tables, one per factor, and what the figures amount to.
std::string benchTables(const std::vector<BenchFactor>& factors, const std::vector<BenchRow>& rows);

/// One line per row; the units stand in the heading.
std::string benchCsv(const std::vector<BenchRow>& rows);

/// One panel per factor.
std::vector<Chart> benchCharts(const std::vector<BenchFactor>& factors, const std::vector<BenchRow>& rows);

}  // namespace pitviper
