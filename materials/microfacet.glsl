// Facets of a rough surface that mirror, each by itself, without the share that a facet reflects [1/sr]: D G / (4 cos(theta_i) cos(theta_o)).
//   Reciprocal. parameters.x: root of twice the mean square slope along one direction. The half vector's sine comes from a cross product, so that
//   lobes of a thousandth of a radian keep their digits.

// Slopes as of Trowbridge and Reitz (GGX): D = a^2 / (pi (a^2 cos^2 + sin^2)^2), shadowing and masking of one height (Smith).
// Source: Walter et al. 2007, equations 33 and 34; Heitz 2014, equation 99.
PHYSICS Real trowbridgeLobe(Vec4 parameters, Vec3 normal, Vec3 toLight, Vec3 toViewer) {
  Real a2 = parameters.x * parameters.x, ci = dot(normal, toLight), co = dot(normal, toViewer);
  if (ci <= 0.0 || co <= 0.0) return 0.0;
  Vec3 both = toLight + toViewer, across = cross(normal, both);
  Real s2 = min(dot(across, across) / dot(both, both), Real(1.0));
  Real q = a2 * (1.0 - s2) + s2;
  Real seen = 0.5 / (co * sqrt(a2 + (1.0 - a2) * ci * ci) + ci * sqrt(a2 + (1.0 - a2) * co * co));
  return 0.318309886183791 * a2 / (q * q) * seen;
}
