#pragma once
// Tables of numbers in files: a header that names each column with its unit in brackets, "wavelength [um], reflectance [1]", and rows of as many numbers.
// Lines that begin with # are comments.
#include <filesystem>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {

struct CsvColumn {
  std::string name, unit;
  Location where;  ///< of the unit
};

struct CsvTable {
  std::string file;
  std::vector<CsvColumn> columns;
  std::vector<double> values;  ///< [row][column]
  std::vector<int> lines;      ///< by row
  std::size_t rows() const { return lines.size(); }
  double at(std::size_t row, std::size_t column) const { return values[row * columns.size() + column]; }
  Location whereOf(std::size_t row) const { return {file, lines[row], 1, -1}; }
};

/// Errors: UserError for a file that cannot be read, has no header with units, rows of other lengths, cells that are no finite numbers, or more than
/// `mostRows`.
CsvTable readCsvTable(const std::filesystem::path& file, const FileWanted& wanted, std::size_t mostRows, const Location& askedAt);

}  // namespace pitviper
