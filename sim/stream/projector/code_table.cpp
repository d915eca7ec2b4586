#include "sim/stream/projector/code_table.hpp"

#include <algorithm>

namespace pitviper {

std::vector<ShownCode> codeTable(const std::vector<std::uint8_t>& levels) {
  std::vector<ShownCode> table(65536);
  for (size_t code = 0; code < table.size(); ++code) {
    if (levels.empty()) {
      table[code] = {static_cast<std::uint8_t>(code >> 8), static_cast<std::uint8_t>(code & 255), 0, 255};
    } else {
      const std::uint8_t level = levels[std::min(code, levels.size() - 1)];
      table[code] = {level, level, level, 255};
    }
  }
  return table;
}

}  // namespace pitviper
