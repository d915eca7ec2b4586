#pragma once
// A line of JSON as what models read from.
#include <nlohmann/json.hpp>

#include "sim/parameters/value.hpp"

namespace pitviper {

/// Numbers as they would be written. Deeper than 16: UserError.
Value valueOf(const nlohmann::ordered_json& json, const Location& where, int depth = 0);

}  // namespace pitviper
