#pragma once
// What a user says of a file of others where it does not say so itself, and what came of the file.
#include <optional>
#include <string>
#include <vector>

namespace pitviper {

enum class SpectralAxis { Micrometre, Nanometre, Angstrom, PerCentimetre, ElectronVolt };
enum class SpectrumQuantity { Reflectance, Transmittance, Emissivity };

struct ImportChoices {
  std::optional<SpectralAxis> axis = {};
  std::optional<double> scale = {};  ///< of the values: 1, or 0.01 for per cent
  std::optional<SpectrumQuantity> quantity = {};
  std::optional<int> column = {};  ///< of the values, from 1
  std::string wavelengths = {};    ///< the file that has the wavelengths of a file of one column
};

struct ImportedMaterial {
  std::string yaml;                ///< with the notes at its head
  std::vector<std::string> notes;  ///< what was changed, left out or taken for granted
};

}  // namespace pitviper
