#pragma once
// The air that bodies fly through: US Standard Atmosphere 1976.
namespace pitviper {

/// Source: U.S. Standard Atmosphere, 1976 (NOAA, NASA, USAF): table 4 (layers of geopotential height), equations (18) geopotential height, (23) temperature,
/// (33a) and (33b) pressure, (42) density, (50) speed of sound, (51) dynamic viscosity. Its gas constant is 8314.32 J/(kmol K).
/// Valid: -5 to 86 km; between 80 and 86 km temperature is that of molecular scale, at most 0.042 % above the kinetic one.
/// Below -5 km: as at -5 km. Above 86 km: temperature is held and pressure falls exponentially over geopotential height. Density is then 3 % above that of the
/// document at 100 km and 24 % below at 120 km, less and less beyond, where there is hardly drag.
struct StandardAir {
  double temperature_K = 288.15;
  double pressure_Pa = 101325.0;
  double density_kg_m3 = 1.225;
  double soundSpeed_m_s = 340.294;
  double viscosity_Pa_s = 1.7894e-5;
};

/// At a geometric height above sea level; the ellipsoid stands for it (the geoid is within 110 m of it, 1.3 % of density).
StandardAir standardAir(double height_m);

/// Geopotential height [m] of a geometric one.
double geopotentialHeight_m(double height_m);

}  // namespace pitviper
