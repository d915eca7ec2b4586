//@use sim/radiometry/glsl/exponential.glsl
// The slot `path` for air of one absorber, as rich everywhere on a way as airLength() says: tau = exp(-gamma s), L_path = L_m (1 - tau). Before it stands
//   float airLength(float height_m, float sinElevation, float range_m)   // amount on a way [m of air at extinction gamma]
// Source: Duvenhage 2006 section 4.4; PHYSICS section 2 form of it. gamma extinction [1/m], s amount [m], L_m source radiance [W/(m2 sr um)].
// Valid: all s >= 0, infinite included. Towards the sun the way ends where the air does, at view.earth.y; air without a top has the sun's
// irradiance as it is at the scene.
struct AirPath {
  float length;  // [m]
  float beyond;  // of the last stretch, from differences at the stretch itself: a far small body's keeps its digits
};

AirPath airFromCamera(float range) { return AirPath(airLength(view.up.w, sinElevation_, range), 0.0); }

AirPath airBeyond(AirPath near, float nearRange, float height, float sinElevation, float length) {
  float more = airLength(height, sinElevation, length);
  return AirPath(near.length + more, more);
}

AirPath airToSun(AirPath camera, float height) {
  return AirPath(camera.length + (view.earth.y >= kFar ? 0.0 : airLength(height, sunElevation_, kFar)), 0.0);
}

AirPath airToLight(AirPath camera, float height, float sinElevation, float distance) {
  return AirPath(camera.length + airLength(height, sinElevation, distance), 0.0);
}

Real pathTransmittance(int i, AirPath p) { return exp(-nodes.node[i].x * p.length); }

Real pathRadiance(int i, AirPath p) { return nodes.node[i].y * oneMinusExp(nodes.node[i].x * p.length); }

Real pathDepth(int i, AirPath near, AirPath far) { return nodes.node[i].x * far.beyond; }

Real pathInside(int i, AirPath near, AirPath far) {
  return pathTransmittance(i, near) * nodes.node[i].y * oneMinusExp(nodes.node[i].x * far.beyond);
}

Real pathSeen(int i, AirPath p, Real radiance) {
  Real depth = nodes.node[i].x * p.length;
  return radiance * exp(-depth) + nodes.node[i].y * oneMinusExp(depth);
}
