#pragma once
// What a display shows for each code.
#include <array>
#include <cstdint>
#include <vector>

namespace pitviper {

/// Red, green, blue, 255, as they lie in a picture's memory.
using ShownCode = std::array<std::uint8_t, 4>;

/// One for each of 65536 codes: grey by `levels`, of which the last is held, or where there are none the code itself, high byte in red and low byte in green.
std::vector<ShownCode> codeTable(const std::vector<std::uint8_t>& levels);

}  // namespace pitviper
