#pragma once
// What a projector's screen must be sent, as somebody measured it.
#include <cstdint>
#include <string>
#include <vector>

namespace pitviper {

/// A CSV file with columns `code [1]`, which rises from 0 to the highest that frames have (65535 at most), and `level [1]`, 0 to 255; straight between rows.
/// Returns the level of each code. Errors: UserError.
std::vector<std::uint8_t> readProjectorTable(const std::string& file);

}  // namespace pitviper
