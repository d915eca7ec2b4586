#pragma once
// Tables over wavelength and angles, as scenarios write them: of a BRDF, an emissivity, a transmittance.
#include <vector>

#include "sim/model/component.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

/// What a table holds, for its messages.
struct AngleTableKind {
  const char* name;
  const char* range;
  double most;
};
std::string aTable(const AngleTableKind& kind);

/// One axis of angles.
const ParameterTable& angleAxisTable();
AngleAxis readAngleAxis(const Value& value);
/// Rising wavelengths [um] of a table.
std::vector<double> readTableWavelengths(const Value& list, const AngleTableKind& kind);
/// values[angle 2][angle 1][wavelength] of `r`, with a nesting level left out for each missing axis; `extents`: entries from the outermost level on.
std::vector<double> readTableValues(const Record& r, const AngleTableKind& kind, const std::vector<size_t>& extents);

}  // namespace pitviper
