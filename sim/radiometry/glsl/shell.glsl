// How much of a straight way lies within a shell around the earth [m]: layers with edges, clouds, are told in closed form. Shared by GLSL (float) and
// C++ (double).
//   From a height h over radius R with sine of elevation e the way crosses a height t where s = -b -+ sqrt(b^2 + c),  b = (R + h) e,  c = (t - h)(2 R + t + h);
//   each root as what loses no digits. Source: the line's distance from the centre, squared, set to (R + t)^2.
PHYSICS Real lengthBelow(Real top_m, Real height_m, Real sinElevation, Real range_m, Real earthRadius_m) {
  Real b = (earthRadius_m + height_m) * sinElevation;
  Real c = (top_m - height_m) * (2.0 * earthRadius_m + top_m + height_m);
  Real d = b * b + c;
  if (d <= 0.0) return 0.0;
  Real root = sqrt(d);
  if (c >= 0.0) return min(range_m, b > 0.0 ? c / (b + root) : root - b);
  if (b >= 0.0) return 0.0;
  Real enter = -c / (root - b);
  return max(min(range_m, root - b) - enter, 0.0);
}

PHYSICS Real lengthInShell(Real low_m, Real high_m, Real height_m, Real sinElevation, Real range_m, Real earthRadius_m) {
  return max(lengthBelow(high_m, height_m, sinElevation, range_m, earthRadius_m) - lengthBelow(low_m, height_m, sinElevation, range_m, earthRadius_m), 0.0);
}
