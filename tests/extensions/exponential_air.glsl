//@use sim/radiometry/glsl/exponential.glsl
// Amount of air that thins out with height as exp(-h / H), over flat ground [m at its density at height 0]:
//   W = exp(-h / H) s (1 - exp(-x)) / x,  x = s e / H,  e sine of the elevation, s length.
// Source: integral of exp(-(h + e s) / H) ds. Valid: upwards everywhere, downwards as far as exp(-x) fits a float (x > -80).
PHYSICS Real exponentialAmount(Real height_m, Real sinElevation, Real range_m, Real scale_m) {
  Real x = range_m * sinElevation / scale_m, up = abs(x);
  // Downwards (1 - exp(-x)) / x = exp(|x|) (1 - exp(-|x|)) / |x|.
  Real mean = (x < 0.0 ? exp(up) : Real(1.0)) * (up < 1.0e-12 ? Real(1.0) : oneMinusExp(up) / up);
  return exp(-height_m / scale_m) * range_m * mean;
}
