// Energy-normalised lobe about the direction to the viewer itself [1/sr]: (n + 2) / (2 pi) cos^n(beta), beta between the directions to light and viewer.
// Phong's lobe turned by 180 degrees about the normal: its albedo is the same.
PHYSICS Real retroLobe(Vec4 parameters, Vec3 normal, Vec3 toLight, Vec3 toViewer) {
  Real c = dot(normal, toLight) > 0.0 ? dot(toLight, toViewer) : 0.0;
  return c > 0.0 ? (parameters.x + 2.0) * 0.159154943091895 * exp(parameters.x * log(c)) : 0.0;
}
