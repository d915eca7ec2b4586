#pragma once
// Spectra and optical constants in others' formats, as this project's YAML.
#include <filesystem>
#include <optional>
#include <string>

namespace pitviper {

/// refractiveindex.info's YAML (tabulated n, k, nk and formulas 1, 2, 4 without powers of their own, 5) as a substance; a text file with two columns
/// (ECOSTRESS, USGS: "Name:" lines at the head, wavelengths in um, reflectance in per cent or as a share) as a Lambertian material. Nothing for a file of
/// this project; UserError for one of theirs that cannot be taken.
std::optional<std::string> importedYaml(const std::filesystem::path& file);

}  // namespace pitviper
