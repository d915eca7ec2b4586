#pragma once
// Rows of a run of MODTRAN, whatever file they come from: checked, in W/(m2 um), and turned to rising wavelength.
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/tape7.hpp"

namespace pitviper::tape7 {

/// What a column of a radiance run holds, by its name in a tape7 (PTH_THRML, SOL@OBS).
Tape7Quantity radianceQuantity(const std::string& name);

/// Fills a run, its columns already named, row by row. Errors: UserError at the place given.
class Rows {
 public:
  /// `fix`: what to do about a wavenumber that is none; `again`: about a value that is none.
  Rows(Tape7Run& run, std::string fix, std::string again) : run_(run), fix_(std::move(fix)), again_(std::move(again)) {}

  const std::vector<double>& wavenumbers() const { return wavenumber_; }
  /// Begins a row. `found`: as it may stand in a message.
  void begin(double wavenumber_per_cm, const Location& at, const std::string& found);
  /// A value of this row as MODTRAN writes it: spectral densities in W/(cm2 cm-1).
  void add(Tape7Column& column, double written, const Location& at, const std::string& found) const;
  void addGap(Tape7Column& column, int line) const;
  /// Leaves out what was not computed, and turns everything from rising wavenumber to rising wavelength.
  void finish();

 private:
  Tape7Run& run_;
  std::string fix_, again_;
  std::vector<double> wavenumber_;
};

}  // namespace pitviper::tape7
