#pragma once
#include "sim/parameters/table.hpp"

namespace pitviper::tables {
const ParameterTable& flare();
const ParameterTable& flareDirection();
const ParameterTable& flareSequence();
}  // namespace pitviper::tables
