#pragma once
#include "sim/parameters/table.hpp"

namespace pitviper::tables {
const ParameterTable& plume();
const ParameterTable& plumeNozzle();
const ParameterTable& plumeSpecies();
const ParameterTable& plumeGrid();
const ParameterTable& plumeArrays();
}  // namespace pitviper::tables
