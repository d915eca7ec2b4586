#pragma once
// Paths bent by refraction, integrated finely: apparent places of what stands in the sky, and what AbsorberTable's own lines are held against.
//
// Law: n(r) r cos e = constant (Bouguer) through spherical shells; ds = dr / sin e.   n - 1 = N(lambda) rho(h) / rho(0).
//   N refractivity at sea level; rho the density of air, from the table's scatterer; e elevation; r distance from the earth's centre.
// Source: Edlen 1966, Metrologia 2, 71, dispersion of dry air at 15 C and 1013.25 hPa; Born and Wolf, Principles of Optics, 3.2.
// Valid: n r rising with height (no ducts: |dn/dh| below 1.57e-7 per m); water vapour left out (below 1 % of n - 1 outside its bands); the dispersion
// formula holds for 0.2-2 um and is nearly constant beyond, but for resonances of CO2 near 4.3 and 15 um.
#include <cmath>
#include <vector>

#include "atmosphere/absorber_table.hpp"

namespace pitviper {

/// n - 1 of dry air at 15 C and 1013.25 hPa, vacuum wavelength from 0.2 um.
double airRefractivity(double wavelength_um);

struct BentPath {
  std::vector<PathStation> stations;  ///< as AbsorberTable::stations(); ranges are lengths along the bent path
  double sinElevationAtEnd = 0.0;
  double bending_rad = 0.0;  ///< by how much its direction turned in all
  bool endsAtGround = false;
};

/// From a height, with the sine of its apparent elevation there, to the top of the air or another height above (upwards only), or to the ground (height 0)
/// where it goes down to it. A path that goes down and misses the ground comes up again. From above the air it enters straight.
/// `refractivity` as from airRefractivity(); 0 gives straight lines. `count`: further stations, even in the square root of the height climbed.
/// Quadrature as AbsorberTable::amounts(). Errors: std::invalid_argument for a table without a scatterer, or an end below the beginning.
BentPath bentPath(const AbsorberTable& air, double refractivity, double height_m, double sinElevation, double earthRadius_m, double endHeight_m = INFINITY,
                  int count = 32);

/// By how much light from space is turned on its way to a height, where it comes from an apparent elevation; below the lowest that the ground leaves free, what
/// it is there. Errors as bentPath().
double bendingFromSpace(const AbsorberTable& air, double refractivity, double height_m, double sinElevation, double earthRadius_m);

}  // namespace pitviper
