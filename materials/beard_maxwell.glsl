//@use sim/radiometry/glsl/exponential.glsl
//@use sim/radiometry/glsl/arc_tangent.glsl
// Beard and Maxwell's two parts [1/sr], in the form of the Nonconventional Exploitation Factors database. parameters: B, sigma, tau [rad], Omega [rad].
// First surface, without R(beta) / R(0): what a retroreflection scan shows, B / (cos(t) (sigma^2 + tan^2 t)) at the facets' tilt t, times
// cos^2 t / (cos_i cos_o) and a shadow (1 + (t / Omega) exp(-2 beta / tau)) / (1 + t / Omega), beta: between light and half vector.
// Source: J. R. Maxwell, J. Beard et al., ERIM 39800-78-T (1973); modified Cauchy scan: R. G. Priest and T. A. Germer (2000). Reciprocal.

PHYSICS Real beardMaxwellFacets(Vec4 parameters, Vec3 normal, Vec3 toLight, Vec3 toViewer) {
  Real ci = dot(normal, toLight), co = dot(normal, toViewer);
  if (ci <= 0.0 || co <= 0.0) return 0.0;
  Vec3 both = toLight + toViewer;
  Real size = max(length(both), Real(1.0e-9)), ct = min(dot(normal, both) / size, Real(1.0)), st = length(cross(normal, both)) / size;
  // |l + v| = 2 cos(beta), |l - v| = 2 sin(beta).
  Real tilt = arcTangent(st / max(ct, Real(1.0e-9))), beta = arcTangent(length(toLight - toViewer) / size);
  Real scan = parameters.x * ct / (parameters.y * parameters.y * ct * ct + st * st);
  Real shadow = (1.0 + tilt / parameters.w * exp(-min(2.0 * beta / parameters.z, Real(80.0)))) / (1.0 + tilt / parameters.w);
  return scan * ct * ct / (ci * co) * shadow;
}

// The same with the shadow of grooves, min(1, 2 ct co / cb, 2 ct ci / cb), without which grazing views return without end. Source: Torrance and Sparrow 1967.
PHYSICS Real beardMaxwellBounded(Vec4 parameters, Vec3 normal, Vec3 toLight, Vec3 toViewer) {
  Vec3 both = toLight + toViewer;
  Real size = max(length(both), Real(1.0e-9)), ct = dot(normal, both) / size, cb = 0.5 * size, least = min(dot(normal, toLight), dot(normal, toViewer));
  if (least <= 0.0) return 0.0;
  return beardMaxwellFacets(parameters, normal, toLight, toViewer) * min(Real(1.0), 2.0 * ct * least / cb);
}
