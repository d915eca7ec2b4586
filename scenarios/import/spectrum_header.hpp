#pragma once
// What the words above a spectrum's numbers say of them: unit of the axis, quantity and unit of the values, and in which columns they stand.
#include <optional>
#include <string>
#include <vector>

#include "scenarios/import/import_choices.hpp"
#include "scenarios/import/number_lines.hpp"

namespace pitviper {

/// Words that say it, and where.
template <class T>
struct Said {
  T value;
  int line = 0;
};

struct SpectrumHeader {
  std::string title;                       ///< a name, if it has one
  std::optional<Said<SpectralAxis>> axis;  ///< as written, or as the instrument named writes it
  bool axisOfInstrument = false;           ///< the unit is not written: it is the one of its instrument
  bool wavelengths = false;                ///< "wavelength" is written, a unit need not be
  std::optional<Said<SpectrumQuantity>> quantity;
  std::optional<Said<double>> scale;  ///< of the values: 1, or 0.01 for per cent
  bool sharesByCustom = false;        ///< of the USGS library: shares, though its files do not say so
  std::size_t x = 0;                  ///< columns, from 0
  std::optional<std::size_t> y;       ///< none: several could be it
};

/// Of lines above `columns` columns parted by `style`. A line of units or of names of columns, and lines such as "X Units: ..." or "##XUNITS=...", count before
/// other words; names and descriptions of samples do not count. UserError at its own line for words that contradict each other, and for quantities that
/// no surface has (radiance, counts, absorbance ...), unless `choices` has the answer.
SpectrumHeader readSpectrumHeader(const std::vector<std::string>& head, std::size_t columns, CellStyle style, const ImportChoices& choices,
                                  const std::string& file);

}  // namespace pitviper
