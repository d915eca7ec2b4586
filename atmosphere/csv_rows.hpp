#pragma once
// Rows of a table of air below their columns, whatever parts the cells, made into air.
#include <map>
#include <span>
#include <string>
#include <vector>

#include "atmosphere/csv_columns.hpp"
#include "atmosphere/tabulated_air.hpp"

namespace pitviper::csv {

class Rows {
 public:
  /// `header`: the line that names the columns; all transmittances have a range, in their name or in a column.
  Rows(std::string file, std::vector<Column> columns, int header) : file_(std::move(file)), columns_(std::move(columns)), header_(header), line_(header) {}

  /// `width`: of the line. Errors: UserError at the cell.
  void add(std::span<const Cell> cells, int line, int width);
  /// The path radiance of another file, over the same wavelengths and the only range of this one. Errors: UserError where they are others.
  void join(Rows radiance);
  /// Errors: UserError for rows that do not fit each other.
  TabulatedAir make();

 private:
  struct Entry {
    double wavelength_um = 0.0;
    double transmittance = 1.0;
    double radiance = 0.0;
    int line = 0;
  };

  [[noreturn]] void fail(int column, const std::string& wrong, const std::string& expected, const std::string& fix, int line = 0) const;
  double value(const Cell& cell, const Column& column, double low, double high) const;
  double spectral(const Cell& cell, const Column& column) const;
  void append(double range, const Entry& entry, double source, const Column& axis, int axisColumn, int rangeColumn);
  bool hasColumn(Meaning m) const;
  /// Rising wavelengths, the same for all ranges.
  void order();
  TabulatedAir::Data begin() const;
  TabulatedAir fromExtinction() const;
  TabulatedAir fromTransmittance() const;

  std::string file_;
  std::vector<Column> columns_;
  int header_, line_;
  size_t rows_ = 0;
  std::map<double, std::vector<Entry>> table_;  ///< by range [km]; extinction [1/km] stands as the transmittance of range 0
  std::map<double, bool> seesRadiance_;
  std::map<double, double> sources_;  ///< by wavelength
};

}  // namespace pitviper::csv
