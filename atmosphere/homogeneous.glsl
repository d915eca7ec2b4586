//@use sim/radiometry/glsl/exponential.glsl
//@use atmosphere/air_length.glsl
// Homogeneous air: tau = exp(-gamma s), L_path = L_m (1 - tau). Source: Duvenhage 2006 section 4.4; PHYSICS section 2 form of it.
//   gamma extinction [1/m], s length of air [m], L_m source radiance [W/(m2 sr um)]. Valid: all s >= 0, infinite included.
Real airLength(Real height_m, Real sinElevation, Real range_m) {
  return layerLength(height_m, sinElevation, range_m, view.earth.y, view.earth.x);
}

Real sunAirLength(Real height_m) { return view.earth.y >= kFar ? 0.0 : airLength(height_m, sunElevation_, kFar); }

Real pathTransmittance(int i, Real length_m) { return exp(-nodes.node[i].x * length_m); }

Real pathRadiance(int i, Real length_m) { return nodes.node[i].y * oneMinusExp(nodes.node[i].x * length_m); }

// Optical depth of the air of a stretch that begins after another.
Real pathDepth(int i, Real before_m, Real length_m) { return nodes.node[i].x * length_m; }

Real pathSeen(int i, Real radiance) {
  Real depth = nodes.node[i].x * airLength_;
  return radiance * exp(-depth) + nodes.node[i].y * oneMinusExp(depth);
}
