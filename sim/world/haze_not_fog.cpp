#include "sim/world/haze_not_fog.hpp"

#include <cmath>

#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

constexpr double kRadiationFog = 0.24139, kAdvectionFog = 1.22677;
/// Koschmieder's law at a contrast of 2 %, and what molecules scatter at 0.55 um near the ground [1/km] (LOWTRAN 7).
constexpr double kKoschmieder = 3.912, kMolecules_per_km = 0.0116;
/// WMO: fog is what lets nobody see 1 km.
constexpr double kFog_km = 1.0;

}  // namespace

std::string hazeNotFog(const Simulation& sim) {
  const auto* hazy = dynamic_cast<const HasHaze*>(sim.air.get());
  if (!hazy || sim.air->validLow_um() > 0.55 || sim.air->validHigh_um() < 10.0) return {};
  const double visible = hazy->hazePer_km(0.55), infrared = hazy->hazePer_km(10.0);
  if (!(visible > 0.0)) return {};
  const double visibility_km = kKoschmieder / (visible + kMolecules_per_km);
  // To a metre: what is asked for as 1 km is none.
  if (!(visibility_km < kFog_km - 1e-3) || infrared >= 0.99 * kRadiationFog * visible) return {};
  return print(
      "air of %.2g km of visibility is haze here, not fog: it weakens 10 um by %.2g of what it does at 0.55 um, where fog does by 0.24 (radiation fog) to "
      "1.23 (advection fog; LOWTRAN 7): 1 km of this haze lets %.2g %% through at 10 um, of such fogs %.2g to %.2g %%; and haze absorbs %.1g %% of what "
      "it takes at 0.55 um, fog nothing (such fogs are 'aerosol: radiation_fog' and 'advection_fog')",
      visibility_km, infrared / visible, 100.0 * std::exp(-infrared), 100.0 * std::exp(-kRadiationFog * visible), 100.0 * std::exp(-kAdvectionFog * visible),
      100.0 * hazy->hazeAbsorbs(0.55));
}

}  // namespace pitviper
