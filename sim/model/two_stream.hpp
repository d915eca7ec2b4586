#pragma once
// Light that a scattering layer passes on in all, scattered any number of times: two streams, one down and one up.
//
// Law: dU/dt = g1 U - g2 D - w g3 E exp(-t/m),  dD/dt = g2 U - g1 D + w g4 E exp(-t/m);  U, D fluxes up and down, t optical depth from the top, w albedo
// of single scattering, m cosine of the sun's zenith distance, E its irradiance across the beam; D = 0 at the top, U = a (D + m E exp(-t/m)) on a ground
// of albedo a. Eddington's coefficients g1..g4, the forward peak of the phase function taken as not scattered.
// Source: Meador and Weaver 1980, J. Atmos. Sci. 37, 630 (table 1); Joseph, Wiscombe and Weinman 1976, J. Atmos. Sci. 33, 2452 (the peak).
// Valid: an even layer, as wide as it likes; fluxes within some 10 % of exact ones where m is above 0.2 (Meador and Weaver, figures 1 to 6).

namespace pitviper {

class TwoStream {
 public:
  /// Of a layer: optical depth, albedo of single scattering, asymmetry (mean cosine of what a scattering turns light by). `sinSun`: m above.
  TwoStream(double depth, double albedo, double asymmetry, double sinSun, double groundAlbedo);

  /// At a depth from the top, for an irradiance of 1 across the beam.
  struct Fluxes {
    double beam = 0.0;            ///< across it: the sun, with what is scattered so little aside that it still goes its way
    double down = 0.0, up = 0.0;  ///< scattered, on a level plane
  };
  Fluxes at(double depth) const;
  /// All of what falls on a level plane: beam and scattered.
  double onLevel(double depth) const;

 private:
  double scaled(double depth) const { return shrink_ * depth; }
  double shrink_, depth_, sun_, k_, mix_, up_, down_;  ///< shrink_: without the forward peak; up_, down_: factors of the beam
  double rising_ = 0.0, falling_ = 0.0;
};

}  // namespace pitviper
