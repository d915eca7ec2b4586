#include "atmosphere/tape7_summary.hpp"

#include <algorithm>

#include "atmosphere/tape7_spectra.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

std::string kindOf(const Tape7Run& run) {
  constexpr const char* kinds[] = {"transmittance", "thermal radiance", "thermal radiance and scattered sunlight", "direct solar irradiance"};
  const int iemsct = static_cast<int>(run.kind);
  return print("%s (IEMSCT %d)", kinds[iemsct], iemsct);
}

std::string airOf(const Tape7Run& run) {
  constexpr const char* models[] = {"user's at one height", "tropical",         "mid-latitude summer",
                                    "mid-latitude winter",  "subarctic summer", "subarctic winter",
                                    "US standard 1976",     "user's",           "user's"};
  const char* bands = run.bandModel == 'F' || run.bandModel == 'L'   ? "LOWTRAN bands"
                      : run.bandModel == 'C' || run.bandModel == 'K' ? "correlated k"
                                                                     : "MODTRAN bands";
  std::string text = std::string(run.model < 9 ? models[run.model] : "unknown") + " air";
  if (!run.title.empty()) text += " '" + run.title + "'";
  text += print(", %s, haze %d", bands, run.haze);
  if (run.visibility_km) text += print(", visibility %g km", *run.visibility_km);
  if (run.boundaryTemperature_K) text += print(", boundary at %g K", *run.boundaryTemperature_K);
  return text;
}

std::string pathOf(const Tape7Geometry& g) {
  std::string text = g.path == Tape7Path::Horizontal ? "horizontal path" : g.path == Tape7Path::Slant ? "slant path" : "path to space";
  if (g.range_km) text += print(" of %g km", *g.range_km);
  if (g.h1_km) text += print(" from a height of %g km", *g.h1_km);
  if (g.h2_km && g.path == Tape7Path::Slant) text += print(" to %g km", *g.h2_km);
  if (g.zenith_deg) text += print(", zenith angle %g deg", *g.zenith_deg);
  if (g.longPath.value_or(0) == 1) text += ", through the tangent height";
  return text;
}

/// The rows' own spacing: card 4 may have been in other units.
std::string stepOf(const std::vector<double>& wavelength_um) {
  if (wavelength_um.size() < 2) return "";
  double least = 1e9, most = 0.0;
  for (size_t i = 1; i < wavelength_um.size(); ++i) {
    const double step = 1e4 / wavelength_um[i - 1] - 1e4 / wavelength_um[i];
    least = std::min(least, step), most = std::max(most, step);
  }
  return most - least < 0.015 ? print(", every %g cm-1", 0.01 * static_cast<int>(50.0 * (least + most) + 0.5))
                              : print(", every %.2f to %.2f cm-1", least, most);
}

}  // namespace

std::string describe(const Tape7Run& run) {
  const auto& w = run.wavelength_um;
  std::string text = print("run %d: ", run.number) + kindOf(run) + "\n  " + airOf(run) + "\n  " + pathOf(run.geometry) + "\n  ";
  text += print("%.5g to %.5g um (%.2f to %.2f cm-1), %zu values", w.front(), w.back(), 1e4 / w.back(), 1e4 / w.front(), w.size()) + stepOf(w);
  if (run.resolution_per_cm > 0.0) text += print(", resolution %g cm-1", run.resolution_per_cm);
  text += "\n";
  const Spectrum transmittance = totalTransmittance(run);
  for (const auto& [low, high] : {std::pair{3.0, 5.0}, std::pair{8.0, 12.0}}) {
    const double from = std::max(low, w.front()), to = std::min(high, w.back());
    if (!(from < to)) continue;
    text += print("  mean transmittance %.5g over %.5g to %.5g um", transmittance.integral(from, to) / (to - from), from, to);
    text += from > low || to < high ? print(", all there is of %g to %g um\n", low, high) : std::string("\n");
  }
  return text;
}

}  // namespace pitviper
