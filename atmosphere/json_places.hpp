#pragma once
// Where values stand in a JSON text, for messages: the reader of JSON keeps no places.
#include <span>
#include <string>
#include <string_view>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// Line and column of a byte of a text.
Location placeOfByte(std::string_view text, const std::string& file, size_t byte);

/// Place of a value of a text that is sound JSON: `way` are the keys and indices from the top. Where a step is missing, that of the value before it.
Location placeInJson(std::string_view text, const std::string& file, std::span<const std::string> way);

}  // namespace pitviper
