#pragma once
#include "sim/parameters/table.hpp"

namespace pitviper::tables {
const ParameterTable& cumulus();
const ParameterTable& cumulusFieldTable();
}  // namespace pitviper::tables
