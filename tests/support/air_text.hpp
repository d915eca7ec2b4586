#pragma once
// Tables of air as files hold them, from functions of wavelength and range.
#include <functional>
#include <span>
#include <string>

namespace pitviper::test {

/// Of wavelength [um] and range [km]: transmittance, or path radiance [W/(m2 sr um)].
using OfPath = std::function<double(double wavelength_um, double range_km)>;

/// A tape7 of thermal radiance runs (IEMSCT 1) along level paths, one per range, in MODTRAN 4's fixed columns.
std::string tape7Text(int from_per_cm, int to_per_cm, int step_per_cm, std::span<const double> ranges_km, const OfPath& transmittance, const OfPath& radiance);

/// The same air as MODTRAN 6's JSON: a case of thermal radiance for each range.
std::string modtranJsonText(int from_per_cm, int to_per_cm, int step_per_cm, std::span<const double> ranges_km, const OfPath& transmittance,
                            const OfPath& radiance);

/// The same along one path as MODTRAN 6's comma-separated values, which do not say its range.
std::string modtranCsvText(int from_per_cm, int to_per_cm, int step_per_cm, double range_km, const OfPath& transmittance, const OfPath& radiance);

/// Wavelength, range, transmittance and path radiance, a row each.
std::string airCsvText(double from_um, double to_um, double step_um, std::span<const double> ranges_km, const OfPath& transmittance, const OfPath& radiance);

}  // namespace pitviper::test
