#pragma once
#include "sim/parameters/table.hpp"

namespace pitviper::tables {
const ParameterTable& smoke();
}
