#pragma once
// What a sweep's file says of one measure.
#include <filesystem>

#include "scenarios/sweep/sweep.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

/// An entry of `measures`; files of Python are found from `base`. Errors: UserError.
Measure readMeasure(const Value& entry, const std::filesystem::path& base);

const ParameterTable& truthMeasureTable();
const ParameterTable& statisticMeasureTable();
const ParameterTable& pythonMeasureTable();

}  // namespace pitviper
