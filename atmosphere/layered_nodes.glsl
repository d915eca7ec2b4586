//@use atmosphere/layered.glsl
// Path radiance of each node: for what is seen through something, and for buffered mode.
Real pathRadiance(int i, AirPath p) { return airValue(p, i, NODES, vec4(air.asymmetry[i / 4][i % 4])).x; }
Real pathInside(int i, AirPath near, AirPath far) { return pathRadiance(i, far) - pathRadiance(i, near); }
Real pathSeen(int i, AirPath p, Real radiance) { return radiance * pathTransmittance(i, p) + pathRadiance(i, p); }
