//@use sim/radiometry/glsl/exponential.glsl
// Energy-normalised Phong lobe [1/sr]: (n + 2) / (2 pi) cos^n(alpha), alpha between the view and the mirrored light direction.
//   The cosine comes from the chord, 1 - cos(alpha) = |r - v|^2 / 2, and its power from ln(1 - c), so that exponents to 1e7 keep
//   their digits. Reciprocal. Zero beyond 90 degrees. Its directional-hemispherical reflectance is 1 at normal view and falls off
//   towards grazing.
// Source: Lafortune and Willems 1994 (normalisation); Duvenhage 2006 section 6 (spectral Phong). Valid: n >= 0.
PHYSICS Real phongLobe(Vec4 parameters, Vec3 normal, Vec3 toLight, Vec3 toViewer) {
  Real exponent = parameters.x;
  Vec3 mirrored = 2.0 * dot(normal, toLight) * normal - toLight;
  Vec3 chord = mirrored - toViewer;
  Real c = 0.5 * dot(chord, chord);
  if (c >= 1.0) return 0.0;
  return (exponent + 2.0) * 0.159154943091895 * exp(exponent * logOneMinus(c));
}
