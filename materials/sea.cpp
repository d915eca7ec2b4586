// The sea: facets of water whose slopes follow the wind.
#include <cmath>

#include "materials/facet_components.hpp"
#include "materials/reflection.hpp"

namespace pitviper {
namespace {

/// Mean square slope, both directions together, of a clean surface under a wind 12.5 m above it.
/// Source: C. Cox and W. Munk, J. Opt. Soc. Am. 44, 838 (1954): 0.003 + 5.12e-3 U, 1 to 14 m/s.
double meanSquareSlope(double wind_m_s) { return 0.003 + 5.12e-3 * wind_m_s; }

}  // namespace

ReflectionModel seaModel() {
  return {"sea",
          "Facets of water, their slopes normal and alike in all directions, of Cox and Munk's mean square for the wind; shadows of waves on waves are in it, "
          "foam is not. One pixel should hold many waves.",
          {required(within(number("wind", "m/s", "12.5 m above the sea"), 0, 14)),
           withDefault(any("index", "refractive index of the water: a number, the name of a substance, or a map of n and k or a formula"), "water"),
           within(spectrum("pigment", "", "share of light that comes back out of the water"), 0, 1)},
          {},
          [](const Record&) { return 1.0 / 64.0; },
          {},
          {},
          [](const ComponentRecord& r) {
            FacetSpec spec{{},
                           readRefractiveIndex(r.record.value("index"), r.spectrumOf, r.substanceOf),
                           std::sqrt(meanSquareSlope(r.record.number("wind"))),
                           Slopes::Normal,
                           {},
                           true,
                           {},
                           {}};
            if (r.record.given("pigment")) spec.pigment = r.spectrum("pigment");
            return facetComponents(std::move(spec), r.record.where());
          }};
}

}  // namespace pitviper
