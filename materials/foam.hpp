#pragma once
// Whitecaps: how much of the sea they cover, and what they return.

namespace pitviper {

/// Share of the sea that is white, W = 3.84e-6 U^3.41, of the wind 10 m above it [m/s].
/// Source: E. C. Monahan and I. O'Muircheartaigh, J. Phys. Oceanogr. 10, 2094 (1980). Valid 4 to 20 m/s; at most 1. Published laws differ by a factor of
/// three (water and air temperatures, fetch).
double whitecapShare(double wind10_m_s);

/// Effective reflectance of that share, the same in all directions: 0.22 in the visible, fresh and thinning foam together; its fall towards the near
/// infrared relative to 0.44 um: 0.6, 0.5 and 0.15 at 0.85, 1.02 and 1.65 um; 0.02 from 2 um on, a chosen round value.
/// Source: P. Koepke, Appl. Opt. 23, 1816 (1984): 0.22 +- 0.11; R. Frouin, M. Schwindling, P.-Y. Deschamps, J. Geophys. Res. 101, 14361 (1996).
/// Valid: 0.4 to 1.7 um; in the infrared within 0.02 up to 65 degrees (R. Niclos et al., J. Geophys. Res. 112, C12020, 2007: no more than 0.04 above
/// water at 65 degrees). R. Branch et al., J. Atmos. Oceanic Technol. 33 (2016) saw foam's emissivity fall beyond, at 85 degrees 0.23 above still water.
double foamReflectance(double wavelength_um);

}  // namespace pitviper
