#pragma once
// What `bench --accuracy` found: tables for a terminal or a README, CSV for machines, charts for people.
#include <string>
#include <vector>

#include "scenarios/commands/accuracy_bench.hpp"
#include "scenarios/commands/charts.hpp"

namespace pitviper {

/// Markdown: errors per channel in per cent, then as temperature differences of the channels that see bodies of 250 to 330 K.
std::string accuracyTables(const AccuracyReport& report);

/// One line per setting and channel; the units stand in the heading.
std::string accuracyCsv(const AccuracyReport& report);

/// A panel per channel: 99th percentile of the error against frames a second, planned and sampled evenly.
std::vector<Chart> accuracyCharts(const AccuracyReport& report);

}  // namespace pitviper
