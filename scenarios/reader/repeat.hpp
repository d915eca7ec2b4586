#pragma once
// What `every` of a repeated entry does to it.
#include "sim/parameters/value.hpp"

namespace pitviper {

/// Adds the numbers of `steps`, `times` times each, to the numbers that stand in the same place of `value`: key by key in maps, entry by entry in lists of one
/// length, in each entry of a list where the steps are a map. Units may differ, dimensions not; differences of temperatures in degC are as many K.
/// Errors: UserError at the step for keys that are not there and for what is no number.
void addSteps(Value& value, const Value& steps, long long times);

}  // namespace pitviper
