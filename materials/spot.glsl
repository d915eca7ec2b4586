//@use sim/radiometry/glsl/exponential.glsl
// A spot's intensity by that on its axis: cos^n(theta), theta off the axis; 0 from 90 degrees on.
//   parameters.x: n = ln(1/2) / ln cos(beam angle / 2). The integral over all directions is 2 pi / (n + 1); n = 1 is a small Lambertian face. The cosine comes
//   from the chord, 1 - cos(theta) = |d - x|^2 / 2, and its power from ln(1 - c), so that narrow beams keep their digits.
// Source: Kahn and Barry 1997 (generalised Lambertian source); beam angle: CIE S 017 (half of the intensity on the axis). Valid: n >= 0.
PHYSICS Real spotPattern(Vec4 parameters, Vec3 direction) {
  Vec3 chord = direction - Vec3(1.0, 0.0, 0.0);
  Real c = 0.5 * dot(chord, chord);
  if (c >= 1.0) return 0.0;
  return exp(parameters.x * logOneMinus(c));
}
