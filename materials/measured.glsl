//@use sim/radiometry/glsl/arc_tangent.glsl
// Shares of the azimuths at which a BRDF over three angles has tables: linear between, 1 at its own. parameters: its number, azimuths per radian.

PHYSICS Real shareOfAzimuth(Real azimuth, Vec4 parameters) {
  Real away = azimuth * parameters.y - parameters.x;
  return max(Real(0.0), away > 0.0 ? Real(1.0) - away : Real(1.0) + away);
}

// Of the light about the half vector, from the plane of half vector and normal: 0 to 90 degrees, as reciprocity and a mirror image leave it.
// Source: S. Rusinkiewicz, Eurographics Workshop on Rendering 1998 (half and difference angles).
PHYSICS Real differenceAzimuth(Vec4 parameters, Vec3 normal, Vec3 toLight, Vec3 toViewer) {
  Vec3 both = toLight + toViewer, middle = both / sqrt(max(dot(both, both), Real(1.0e-30))), up = normal - middle;
  Real along = dot(toLight, up - dot(up, middle) * middle), across = dot(cross(normal, toLight), middle);
  along = along < 0.0 ? -along : along;
  across = across < 0.0 ? -across : across;
  return shareOfAzimuth(arcTangent(across / max(along, Real(1.0e-30))), parameters);
}

// Between light and viewer about the normal: 0 on the same side to 180 degrees.
PHYSICS Real azimuthBetween(Vec4 parameters, Vec3 normal, Vec3 toLight, Vec3 toViewer) {
  Real along = dot(toLight, toViewer) - dot(normal, toLight) * dot(normal, toViewer), across = dot(cross(toLight, toViewer), normal);
  Real below = along < 0.0 ? -along : along;
  across = across < 0.0 ? -across : across;
  Real angle = arcTangent(across / max(below, Real(1.0e-30)));
  return shareOfAzimuth(along < 0.0 ? Real(3.14159265358979) - angle : angle, parameters);
}
