// Length of air on a ray inside a layer of constant properties with its top at top_m, over a spherical earth [m].
//   A ray from height h (below the top) with sine of elevation e leaves the sphere of radius a + top after
//   s = 2 q / (b + sqrt(b^2 + 2 q)),  b = (a + h) e,  2 q = (top - h)(2 a + top + h);  from above the top it enters after
//   s = -b - sqrt(b^2 + 2 q) (q < 0), if at all.
// Valid: h > -a; the earth itself does not stop the ray (the scene's ground does). Top >= kFar: no top, the range itself.
PHYSICS Real layerLength(Real height_m, Real sinElevation, Real range_m, Real top_m, Real earthRadius_m) {
  if (top_m >= kFar) return range_m;
  Real b = (earthRadius_m + height_m) * sinElevation;
  Real q2 = (top_m - height_m) * (2.0 * earthRadius_m + top_m + height_m);
  Real root = b * b + q2;
  if (root < 0.0) return 0.0;
  root = sqrt(root);
  // The stable form of -b + root on either sign of b.
  Real leave = b >= 0.0 ? q2 / max(b + root, 1.0e-30) : root - b;
  Real enter = q2 >= 0.0 ? 0.0 : max(b >= 0.0 ? -b - root : -q2 / (root - b), 0.0);
  return max(min(range_m, leave) - enter, 0.0);
}
