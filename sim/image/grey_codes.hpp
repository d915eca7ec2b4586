#pragma once
// Pictures as 16-bit grey: what streams and hardware take.
#include <cstdint>
#include <span>

namespace pitviper {

/// code = round((value - low) / step), within 0 and `most`; NaN, which a full pixel's temperature is: `most`. Returns how many were outside, or are the
/// highest. Both spans have the same length.
std::size_t toGreyCodes(std::span<const float> values, double low, double step, std::uint16_t most, std::span<std::uint16_t> codes);

}  // namespace pitviper
