#pragma once
// A measured spectrum in columns, as a material.
#include <filesystem>
#include <string>

#include "scenarios/import/import_choices.hpp"

namespace pitviper {

/// ECOSTRESS, ASTER, USGS (libraries 6 and 7), field spectrometers' and Fourier spectrometers' text and JCAMP-DX: a reflectance becomes a Lambertian surface,
/// an emissivity one of 1 less it, a transmittance a transmission. What the words above the numbers leave open is refused with the choices, unless `choices` or
/// the numbers settle it (wavelengths that only one unit puts on the spectral axis). Values beyond 0 to 1 are brought there, and told. UserError at its line.
ImportedMaterial importSpectrum(const std::string& text, const std::filesystem::path& file, const ImportChoices& choices);

}  // namespace pitviper
