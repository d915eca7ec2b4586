// The sea: facets of water whose slopes follow the wind, and whitecaps.
#include <algorithm>
#include <cmath>

#include "materials/facet_components.hpp"
#include "materials/foam.hpp"
#include "materials/reflection.hpp"
#include "sim/scene/sea_surface.hpp"

namespace pitviper {
namespace {

/// Mean square slope, both directions together, of a clean surface under a wind 12.5 m above it.
/// Source: C. Cox and W. Munk, J. Opt. Soc. Am. 44, 838 (1954): 0.003 + 5.12e-3 U, 1 to 14 m/s.
double meanSquareSlope(double wind_m_s) { return 0.003 + 5.12e-3 * wind_m_s; }
/// Of ripples that are left however finely waves are drawn: Cox and Munk's without wind.
constexpr double kLeastSlope = 0.003;

/// What whitecaps return of light that falls on all of the sea.
std::shared_ptr<ReflectionComponent> foamOf(double share) {
  Spectrum::Table table{{0.3}, {share * foamReflectance(0.3)}, Outside::Hold, "foam"};
  for (double um : {0.44, 0.65, 0.85, 1.02, 1.65, 2.0}) table.wavelength_um.push_back(um), table.value.push_back(share * foamReflectance(um));
  return makeLambertian(Spectrum(std::move(table)));
}

}  // namespace

ReflectionModel seaModel() {
  return {"sea",
          "Facets of water, their slopes normal and alike in all directions, of Cox and Munk's mean square for the wind; shadows of waves on waves are in it. "
          "Whitecaps cover a share of it. One pixel should hold many of the waves that are not drawn.",
          {required(within(number("wind", "m/s", "12.5 m above the sea"), 0, 14)),
           within(number("step", "m", "on the shape `sea`: distance between its places; slopes of waves that it draws are left out of the facets'"), 1e-3, 1e3),
           within(number("foam", "", "share that is white; by the wind unless given"), 0, 1),
           withDefault(any("index", "refractive index of the water: a number, the name of a substance, or a map of n and k or a formula"), "water"),
           within(spectrum("pigment", "", "share of light that comes back out of the water"), 0, 1)},
          {},
          [](const Record&) { return 1.0 / 64.0; },
          {},
          {},
          [](const ComponentRecord& r) {
            const double wind = r.record.number("wind"), foam = r.record.given("foam") ? r.record.number("foam") : whitecapShare(wind);
            double slope = meanSquareSlope(wind);
            if (r.record.given("step")) slope = std::max(kLeastSlope, slope - drawnSlope(WaveSpectrum(wind), r.record.number("step")));
            FacetSpec spec;
            spec.beneath = readRefractiveIndex(r.record.value("index"), r.spectrumOf, r.substanceOf);
            spec.roughness = std::sqrt(slope);
            spec.slopes = Slopes::Normal;
            spec.pigmentApparent = true;
            if (r.record.given("pigment")) spec.pigment = r.spectrum("pigment");
            spec.share = 1.0 - foam;
            MadeReflection made = facetComponents(std::move(spec), r.record.where());
            if (foam > 0.0) made.components.push_back(foamOf(foam));
            return made;
          }};
}

}  // namespace pitviper
