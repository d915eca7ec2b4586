#pragma once
// Spectra and optical constants in others' formats, as this project's YAML.
#include <filesystem>
#include <optional>

#include "scenarios/import/import_choices.hpp"

namespace pitviper {

/// refractiveindex.info's YAML as a substance (importOpticalConstants), a spectrum in columns as a material (importSpectrum). What it gives has been read back:
/// it loads. Nothing for a file of this project; UserError for one of theirs that cannot be taken, and for choices that a file has no use for.
std::optional<ImportedMaterial> importedMaterial(const std::filesystem::path& file, const ImportChoices& choices = {});

}  // namespace pitviper
