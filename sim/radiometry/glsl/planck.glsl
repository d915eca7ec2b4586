//@use sim/radiometry/glsl/exponential.glsl
// Planck's law. Shared by GLSL (float) and C++ (double).

// Spectral radiance of a black body from the two constants of a wavelength.
//   L = (c1L / lambda^5) / (exp(c2 / (lambda T)) - 1)
//   c2OverWavelength_K = c2 / lambda [K], c1OverWavelength5 = c1L / lambda^5 [W/(m2 sr um)], temperature_K >= 0; L [W/(m2 sr um)].
// Source: Planck; c1L = 2 h c^2 = 1.191042972e8 W um4/(m2 sr), c2 = h c / k = 14387.76877 um K (CODATA 2018, exact SI).
// Valid: all temperatures; where c2 / (lambda T) exceeds kExpLimit the result is 0 (true value below 1e-38 of c1L / lambda^5).
PHYSICS Real planckFromConstants(Real c2OverWavelength_K, Real c1OverWavelength5, Real temperature_K) {
  if (temperature_K <= 0.0) return 0.0;
  Real x = c2OverWavelength_K / temperature_K;
  return c1OverWavelength5 * decay(x) / oneMinusExp(x);
}

// The same from the wavelength itself [um].
PHYSICS Real planckRadiance(Real wavelength_um, Real temperature_K) {
  Real l2 = wavelength_um * wavelength_um;
  return planckFromConstants(14387.768775039337 / wavelength_um, 1.1910429723971884e8 / (l2 * l2 * wavelength_um), temperature_K);
}
