#pragma once
// The parameter tables of a gimbal and of the maps in it.
#include "sim/parameters/table.hpp"

namespace pitviper {

struct GimbalTables {
  const ParameterTable &gimbal, &jitter, &jitterAxis, &scan, &tracker;
};
const GimbalTables& tablesOfGimbal();

}  // namespace pitviper
