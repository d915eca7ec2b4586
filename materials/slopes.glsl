//@use sim/radiometry/glsl/exponential.glsl
// Facets whose slopes are normally distributed, as those of a sea: D = exp(-tan^2 / a^2) / (pi a^2 cos^4), a^2 twice the mean square slope along one
//   direction; shadowing and masking of one height (Smith), in the rational form of its integral (0.35 % of it) [1/sr]. Reciprocal.
// Source: Beckmann's distribution as in Walter et al. 2007, equations 25 and 27.
PHYSICS Real slopeLambda(Real a, Real c) {
  Real s2 = max(1.0 - c * c, Real(1.0e-12)), x = c / (a * sqrt(s2));
  return x >= 1.6 ? 0.0 : (1.0 - 1.259 * x + 0.396 * x * x) / (3.535 * x + 2.181 * x * x);
}
PHYSICS Real slopeLobe(Vec4 parameters, Vec3 normal, Vec3 toLight, Vec3 toViewer) {
  Real a = parameters.x, ci = dot(normal, toLight), co = dot(normal, toViewer);
  if (ci <= 0.0 || co <= 0.0) return 0.0;
  Vec3 both = toLight + toViewer, across = cross(normal, both);
  Real s2 = min(dot(across, across) / dot(both, both), Real(1.0)), c2 = max(1.0 - s2, Real(1.0e-12));
  Real d = exp(-min(s2 / (c2 * a * a), Real(80.0))) * 0.318309886183791 / (a * a * c2 * c2);
  return d / (4.0 * ci * co * (1.0 + slopeLambda(a, ci) + slopeLambda(a, co)));
}
