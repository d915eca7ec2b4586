//@use atmosphere/layered.glsl
// Path radiance integrated over each channel beforehand: it depends on the way alone.
Real pathRadiance(int i, AirPath p) { return 0.0; }
Real pathSeen(int i, AirPath p, Real radiance) { return radiance * pathTransmittance(i, p); }
vec4 channelAir(int group, AirPath p) { return airValue(p, group, GROUPS, air.asymmetry[group]); }
