#pragma once
// The words of a line above a spectrum, in the spellings of instruments and libraries made alike.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/import/import_choices.hpp"

namespace pitviper {

/// In small letters: "Wellenzahl [cm^-1]" is {"wavenumber", "percm"}, "R (%)" {"r", "percent"}, "0-1" {"share"}; "um" is any spelling of micrometre.
std::vector<std::string> headerWords(std::string_view line);

enum class Meaning { None, AxisName, Unit, Reflectance, Transmittance, Emissivity, NoSurface, Percent, Share, Deviation };

/// What one of headerWords() says.
Meaning meaningOf(const std::string& word);
/// Of a unit of the axis, or a name that has one (wavenumber); nothing for others.
std::optional<SpectralAxis> axisOf(const std::string& word);

}  // namespace pitviper
