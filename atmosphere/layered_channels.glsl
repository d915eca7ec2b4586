//@use atmosphere/layered.glsl
// What depends on the way alone is integrated over each channel beforehand.
Real pathRadiance(int i, AirPath p) { return 0.0; }
Real pathSeen(int i, AirPath p, Real radiance) {
  Real depth = airDepth(i, p);
  return radiance * exp(-depth) + airBlack(i, depth);
}
vec4 channelAir(int group, AirPath p) { return airValue(p, group); }
