#pragma once
// The report of a sweep: one page for a browser, without scripts and without other files.
#include <filesystem>
#include <vector>

#include "scenarios/sweep/sweep_identity.hpp"
#include "sim/image/atomic_file.hpp"

namespace pitviper {

/// Says in its beginning whose it is, as pages of runs do: by the sweep's name and sha256.
/// Errors: OutputError, and what `mayReplace` throws.
void writeSweepPage(const std::filesystem::path& file, const SweepIdentity& sweep, const std::vector<SweepRow>& rows, bool isSaltelli,
                    const MayReplace& mayReplace = {});

}  // namespace pitviper
