#pragma once
// What a material names besides itself: substances and spectra of the libraries.
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/parameters/spectrum_value.hpp"

namespace pitviper {

/// A file of materials/substances as a tree; UserError at `asked` where there is none.
Value substanceTree(const std::string& name, const Location& asked, const Libraries& libraries);

/// Reads spectra whose files are relative to `base`.
SpectrumReader spectraIn(const std::filesystem::path& base, const Libraries& libraries);

}  // namespace pitviper
