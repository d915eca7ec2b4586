#pragma once
// What MODTRAN 6 calls its spectra in its JSON and CSV, and what a tape7 calls them.
#include <optional>
#include <string>
#include <string_view>

namespace pitviper {

/// The name in a tape7 (COMBIN_TRANS and H2O_TRANS of transmittance runs, TOT_TRANS and THRML_EM of radiance runs) for a name in JSON (TOT_TRANS,
/// TRANS_H2O, SOL_AT_OBS) or CSV (total transmittance, path emission, H2O trans), upper or lower case; none for a name of neither.
/// Source: keywords and names of spectra as https://github.com/brianschubert/pymod6 (tests/test_io.py) pairs them on MODTRAN 6's own output.
std::optional<std::string> tape7Name(std::string_view name, bool transmittanceRun);

}  // namespace pitviper
