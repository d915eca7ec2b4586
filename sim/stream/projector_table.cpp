#include "sim/stream/projector_table.hpp"

#include <cmath>

#include "sim/parameters/csv_table.hpp"

namespace pitviper {

std::vector<std::uint8_t> readProjectorTable(const std::string& file) {
  constexpr std::size_t kMostRows = 65536;
  constexpr double kMostCode = 65535.0, kMostLevel = 255.0;
  const CsvTable t = readCsvTable(file, {}, kMostRows, {"--projector-table", 0, 0, -1});
  if (t.columns.size() != 2 || t.columns[0].name != "code" || t.columns[1].name != "level")
    throw UserError({file, 1, 1, -1}, "not a projector's table", "columns 'code [1], level [1]'", "name them so");
  std::vector<std::uint8_t> levels;
  for (std::size_t row = 0; row < t.rows(); ++row) {
    const double code = t.at(row, 0), level = t.at(row, 1);
    const bool rises = row == 0 ? code == 0.0 : code > t.at(row - 1, 0);
    if (!rises || code > kMostCode || code != std::floor(code))
      throw UserError(t.whereOf(row), "codes that do not rise from 0 in whole numbers to 65535 at most", "the first 0, each more than the one before",
                      "sort them");
    if (!(level >= 0.0 && level <= kMostLevel)) throw UserError(t.whereOf(row), "a level beyond what a screen takes", "0 to 255", "correct it");
    for (std::size_t c = levels.size(); c <= static_cast<std::size_t>(code); ++c) {
      const double before = row == 0 ? 0.0 : t.at(row - 1, 0), share = row == 0 ? 1.0 : (static_cast<double>(c) - before) / (code - before);
      levels.push_back(static_cast<std::uint8_t>(std::lround(level * share + (row == 0 ? 0.0 : t.at(row - 1, 1) * (1.0 - share)))));
    }
  }
  if (levels.size() < 2) throw UserError({file, 0, 0, -1}, "a table of less than two codes", "one that spans what frames have", "measure more");
  return levels;
}

}  // namespace pitviper
