#pragma once
// Optical constants of refractiveindex.info, as a substance.
#include <string>

#include "scenarios/import/import_choices.hpp"
#include "sim/parameters/value.hpp"

namespace pitviper {

/// Of the database's YAML (`tree`, read from `text`): tabulated n, k and nk and formulas 1 to 9, each of n and k once. Wavelengths are those of the file to the
/// last digit, falling tables turned, rows beyond the spectral axis left out and told. UserError at its own line for what cannot be taken.
ImportedMaterial importOpticalConstants(const Value& tree, const std::string& text, const std::string& name);

}  // namespace pitviper
