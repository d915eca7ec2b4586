// Where a ray meets the sphere that stands for the earth [m], or kFar. Shared by GLSL (float) and C++ (double).
//   From a height h over radius R with sine of elevation e: s = c / (sqrt(b^2 - c) - b),  b = (R + h) e,  c = h (2 R + h): the nearer root.
//   From on or below the sphere a ray that goes down meets it at once. Source: the line's distance from the centre, squared, set to R^2.
PHYSICS Real groundRange(Real height_m, Real sinElevation, Real earthRadius_m) {
  if (sinElevation >= 0.0) return kFar;
  if (height_m <= 0.0) return 0.0;
  Real b = (earthRadius_m + height_m) * sinElevation;
  Real c = height_m * (2.0 * earthRadius_m + height_m);
  Real root = b * b - c;
  return root < 0.0 ? kFar : c / (sqrt(root) - b);
}
