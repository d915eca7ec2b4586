#pragma once
// What to do about values in a unit of another dimension.
#include <string>
#include <string_view>

namespace pitviper {

/// How values in `unit` become values in `canonical`, for messages: by a formula where the two are the same light told otherwise (per wavenumber, in photons,
/// without a solid angle). Another name for the unit alone would change nothing.
std::string conversionOf(std::string_view unit, std::string_view canonical);

}  // namespace pitviper
