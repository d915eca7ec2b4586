// Geometry and identity of what a pixel sees: (area, w1, w2, range), (normal east, north, up, temperature),
// (entity, part, cos theta_v, 0). Where nothing is seen everything is 0.

void writeTruth(float cosPsi) {
  if (isSurface_ == 0.0) {
    truthGeometry = truthNormal = truthIdentity = vec4(0.0);
    return;
  }
  float area = fragmentArea(pixelSolidAngle(view.aperture.y, cosPsi), range_, cosView_);
  float w1 = lightCos_ > 0.0 ? fragmentFromLight(area, lightCos_, lightDistance2_) : 0.0;
  truthGeometry = vec4(area, w1, apertureFromFragment(view.aperture.x, cosPsi, range_), range_);
  vec3 n = normal_.x * draw_.row0.xyz + normal_.y * draw_.row1.xyz + normal_.z * draw_.row2.xyz;
  truthNormal = vec4(dot(n, view.east.xyz), dot(n, view.north.xyz), dot(n, view.up.xyz), truthTemperature());
  truthIdentity = vec4(float(draw_.table.w), draw_.state.y, cosView_, 0.0);
}
