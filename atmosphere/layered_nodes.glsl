//@use atmosphere/layered.glsl
// Path radiance of each node: for what is seen through something, and for buffered mode.
Real airRest(int i, AirPath p) { return airValue(p, i / 4)[i % 4]; }
Real pathRadiance(int i, AirPath p) { return airBlack(i, airDepth(i, p)) + airRest(i, p); }
Real pathInside(int i, AirPath near, AirPath far) {
  return pathTransmittance(i, near) * airBlack(i, pathDepth(i, near, far)) + airRest(i, far) - airRest(i, near);
}
Real pathSeen(int i, AirPath p, Real radiance) {
  Real depth = airDepth(i, p);
  return radiance * exp(-depth) + airBlack(i, depth) + airRest(i, p);
}
