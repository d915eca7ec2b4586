#pragma once
// Sunlight scattered once by structured air, and what that air emits itself: the sky, and the haze between camera and target.
//
// Law: L = E0 integral of (beta_R P_R + beta_A P_A) exp(-D) ds + integral of B(T) exp(-t) dt,
//   D = sum over k of c_k (W_k,view + W_k,sun)^a_k: the amounts on both legs are added before the exponential (absorber_table.hpp);
//   P_R = 3/(16 pi) (1 + cos^2) molecules, P_A = (1 - g^2)/(4 pi (1 + g^2 - 2 g cos)^1.5) haze, cos of the angle between sunlight and what goes
//   on to the camera; beta_R [1/km] the table's `scattering`; beta_A albedo x its `haze` and `aerosol`; t optical depth of the view, all of
//   which emits (AirLight::emitted says why); E0 irradiance above the air [W/(m2 um)].
// Source: Chandrasekhar 1960, Radiative Transfer, chapter III (phase functions; first-order scattering); Henyey and Greenstein 1941.
// Valid: scattering optical depth well below 1. Left out: light scattered twice or more and light from the ground (in the visible the sky is a half to
// a third of what is published, at 4.8 um within 1 to 13 % of MODTRAN's: tests/physics/test_scattered_sun.cpp); that the sky is colder than the
// air: where haze scatters, the thermal sky is up to 5 % (3-5 um) and 8 % (8-12 um) above that of absorption alone, and the truth between;
// depolarisation (1.5 % of P_R); refraction; the sun's size. What lies in the earth's shadow gets nothing.
// The LOWTRAN 7 figures that this air was fitted to hold no scattered sunlight: this part rests on closed forms, two MODTRAN runs and two
// published skies.
#include <memory>
#include <vector>

#include "atmosphere/absorber_table.hpp"
#include "sim/model/atmosphere.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Asymmetry of the rural haze by wavelength, 0.2-4.5 um at a relative humidity of 70 %, held beyond (where the haze's share of scattered sunlight
/// is small). Source: Shettle and Fenn 1979 (AFGL-TR-79-0214), as in LOWTRAN 7; 0.015 less in dry air.
Spectrum ruralAsymmetry();

/// A line of sight and the sun, both as seen from the camera.
struct SunlitView {
  double height_m = 0.0;
  double sinElevation = 1.0;
  double azimuthFromSun_rad = 0.0;
  double sinSunElevation = 1.0;
};

/// What one view needs at every wavelength: made once, evaluated for many.
struct SunlitPath {
  struct Station {
    double range_m = 0.0;
    double temperature_K = 0.0;
    bool lit = false;                                ///< whether the sun reaches the stretch that ends here
    std::array<double, kMostAbsorbers> viewPower{};  ///< W_k^a_k from the camera to here
    std::array<double, kMostAbsorbers> bothPower{};  ///< the same with the sun's leg added; unused in shadow
  };
  double cosScatter = 1.0;
  std::vector<Station> stations;
};

/// Views whose weighted sum is the mean of the sky over its dome, weighted by the cosine to the zenith.
struct SkyDome {
  std::vector<SunlitPath> paths;
  std::vector<double> weights;  ///< sum 1
};

/// Values below are at a wavelength [um] where the air has data; OutsideSpectrum is thrown elsewhere. Radiance in W/(m2 sr um).
class ScatteredSun {
 public:
  explicit ScatteredSun(std::shared_ptr<const AbsorberTable> air, double earthRadius_m, Spectrum hazeAsymmetry = ruralAsymmetry());

  /// Stations as AbsorberTable::stations() sets them and at the edge of the earth's shadow. With count 32 scattered sunlight is within 0.3 % of
  /// finer ones in the windows, 3 % in opaque bands (2.7 and 4.5 um); the error falls with the square of count.
  SunlitPath path(const SunlitView& view, double range_m, int count = 32) const;
  /// As far as space or the ground (whose own radiance is not in it; a camera below sea level stands on it).
  SunlitPath pathToEnd(const SunlitView& view, int count = 32) const;
  /// Gauss rule over the sine of the elevation, even over half the azimuths. 10 x 12: within 1 % of finer ones.
  SkyDome dome(double height_m, double sinSunElevation, int elevations = 10, int azimuths = 12) const;

  double scatteredRadiance(double wavelength_um, const SunlitPath& path, double irradiance) const;
  double thermalRadiance(double wavelength_um, const SunlitPath& path) const;
  /// Both of them.
  double radiance(double wavelength_um, const SunlitPath& path, double irradiance) const;
  double transmittance(double wavelength_um, const SunlitPath& path) const;

  /// The sky without the sun's disc, or the air in front of the ground.
  double skyRadiance(double wavelength_um, const SunlitView& view, double irradiance) const;
  /// Cosine-weighted mean of the sky: the uniform sky with the same irradiance on level ground.
  double meanSky(double wavelength_um, const SkyDome& dome, double irradiance) const;
  /// On a surface that faces the sun, at a height [W/(m2 um)]; 0 in the earth's shadow.
  double directSun(double wavelength_um, double height_m, double sinSunElevation, double irradiance) const;

  const AbsorberTable& air() const { return *air_; }
  double earthRadius_m() const { return radius_m_; }

 private:
  struct Optics;
  Optics optics(double wavelength_um) const;
  bool inShadow(double height_m, double sinSunElevation) const;
  std::array<double, kMostAbsorbers> powers(const AbsorberAmounts& amounts) const;

  std::shared_ptr<const AbsorberTable> air_;
  double radius_m_;
  Spectrum asymmetry_;
};

}  // namespace pitviper
