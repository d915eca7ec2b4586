// Puffs of smoke or of a burning cloud, each an element; what overlaps adds up.
//   Texels of a puff: 0 centre, radius across;  1 unit axis, squash (puffScaled);  2 densities of its gases at the centre;
//   3 temperature, factor of own radiance, share of the sun, amount of the first gas towards the sun.
//@use materials/fields/glsl/puff.glsl

vec3 puffOn_(int at) {
  vec4 place = fieldTexel(at), form = fieldTexel(at + 1);
  return puffChord(puffScaled(q_ - place.xyz, form.xyz, form.w, place.w), puffScaled(d_, form.xyz, form.w, place.w));
}

vec2 fieldChord(int at) {
  vec3 chord = puffOn_(at);
  return vec2(chord.x - chord.y, chord.x + chord.y);
}

void fieldLine(int at, int steps) {}

float fieldCut(float s) { return mix(enter_, leave_, s); }

void fieldAdd(int at, float from, float to) {
  float column = perT_ * puffColumn(puffOn_(at), from, to);
  if (column <= 0.0) return;
  vec4 amounts = fieldTexel(at + 2) * column, state = fieldTexel(at + 3);
  float weight = amounts.x + amounts.y + amounts.z + amounts.w;
  amountLow_ += amounts;
  weight_ += weight;
  heat_ += weight * state.x;
  gained_ += weight * state.y;
  lit_ += weight * state.z;
  shade_ += weight * state.w;
}
