#pragma once
// Reflection and transmission of plane layers, by Airy's recursion for each polarisation; double precision.
#include <complex>
#include <vector>

namespace pitviper {

struct FilmLayer {
  std::complex<double> index;  ///< n + ik
  double thickness_um = 0.0;
  bool coherent = true;  ///< its two faces' waves interfere; otherwise their powers add
};

/// Of the power that arrives, unpolarised; what is left is absorbed.
struct FilmPower {
  double reflectance = 0.0, transmittance = 0.0;
};

/// Light from air (n = 1) at an angle of incidence of this sine, through the layers in their order, into `beneath`. Transmittance is of the flux
/// through the last face, just inside `beneath`. Polarisations are averaged after the sum. Source: P. Yeh, Optical Waves in Layered Media (1988),
/// section 4.2; equations 6 to 8 of Durikovic and Kimura (2007) with absorption, see A. Macleod, Thin-Film Optical Filters, section 2.3.
FilmPower filmPower(const std::vector<FilmLayer>& layers, std::complex<double> beneath, double wavelength_um, double sine);

/// Light from beneath, of real index, at this sine there, through the layers from the last to the first, into air: total reflection where n sine > 1.
FilmPower filmPowerFromBeneath(const std::vector<FilmLayer>& layers, double beneath, double wavelength_um, double sine);

}  // namespace pitviper
