// The Sandford-Robertson model's angular parts, without its spectra [1/sr]. parameters: b and e of the model, and 1 for the form as published.
//   Source: B. P. Sandford and D. C. Robertson, Infrared reflectance properties of aircraft paints, IRIS Targets, Backgrounds and Discrimination (1985).

PHYSICS Real sandfordFall(Real b, Real c) { return 1.0 / (1.0 + b * b * (1.0 - c * c) / max(c * c, Real(1.0e-9))); }

// Hemispherical mean of the fall: G = (1 + b^2 ln(b^2) / (1 - b^2)) / (1 - b^2).
PHYSICS Real sandfordMean(Real b) {
  Real q = b * b, p = 1.0 - q;
  if (q < 1.0e-9) return 1.0;
  if (p * p < 1.0e-4) return 0.5 + p / 6.0;
  return (1.0 + q * log(q) / p) / p;
}

// Makes the glint's integral over the hemisphere 1 for light at an incidence of this cosine.
PHYSICS Real sandfordGlint(Real e, Real c) {
  Real p = 1.0 - e * e, root = sqrt(p * p * c * c + 4.0 * e * e);
  return (p * c + (2.0 * e * e + p * p * c * c) / root) / (2.0 * e * e);
}

// g(theta_i) g(theta_o) / (pi G^2).
PHYSICS Real sandfordDiffuseLobe(Vec4 parameters, Vec3 normal, Vec3 toLight, Vec3 toViewer) {
  Real ci = dot(normal, toLight), co = dot(normal, toViewer), mean = sandfordMean(parameters.x);
  if (ci <= 0.0 || co <= 0.0) return 0.0;
  return 0.318309886183791 * sandfordFall(parameters.x, ci) * sandfordFall(parameters.x, co) / (mean * mean);
}

// h(theta_h) / (4 pi H(theta_i) cos(theta_o)), h = 1 / (e^2 cos^2 + sin^2)^2 with e the width: not reciprocal. Else the geometric mean of both ways.
PHYSICS Real sandfordGlintLobe(Vec4 parameters, Vec3 normal, Vec3 toLight, Vec3 toViewer) {
  Real e = parameters.y, ci = dot(normal, toLight), co = dot(normal, toViewer);
  if (ci <= 0.0 || co <= 0.0) return 0.0;
  Vec3 both = toLight + toViewer, across = cross(normal, both);
  Real s2 = min(dot(across, across) / dot(both, both), Real(1.0)), q = e * e * (1.0 - s2) + s2, h = 1.0 / (q * q);
  Real there = sandfordGlint(e, ci) * co, back = sandfordGlint(e, co) * ci;
  return 0.0795774715459477 * h / max(parameters.z > 0.5 ? there : sqrt(there * back), Real(1.0e-9));
}
