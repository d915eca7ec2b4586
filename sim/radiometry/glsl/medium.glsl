//@use sim/radiometry/glsl/segment.glsl
// A layer of emitting gas or smoke with air in it. Shared by GLSL (float) and C++ (double).

// Radiance at the camera of what lies inside a layer and of the air in front of it, per wavelength:
//   L = L_1 + (L_2 - L_1) E(a + g) / E(g) + tau_1 S a E(a + g),   E(x) = (1 - exp(-x)) / x
//   a optical depth of the medium on the way through, g that of the air beside it on the same way; L_1, L_2 path radiance of the air from
//   the camera to where the way enters and leaves, tau_1 transmittance of the air to where it enters, S source radiance of the medium;
//   what lies behind adds exp(-a) (L_behind - L_2), with L_behind as seen without the layer.
//   From dL = tau_air exp(-depth) (S da + S_air dg) with both coefficients constant on the way. Exact for homogeneous air. a = 0: L_2.
PHYSICS Real mediumRadiance(Real a, Real g, Real pathRadiance1, Real pathRadianceInside, Real transmittance1, Real source) {
  Real mean = meanDecay(a + g);
  return pathRadiance1 + pathRadianceInside * mean / meanDecay(g) + transmittance1 * source * a * mean;
}
