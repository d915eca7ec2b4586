// Puffs of smoke or of a burning cloud, each an element; what overlaps adds up.
//   Texels of a puff: 0 centre, radius across;  1 unit axis, squash (puffScaled);  2 densities of its gases at the centre;
//   3 temperature, factor of own radiance, share of the sun, amount of the first gas towards the sun.
//@use materials/fields/glsl/puff.glsl
//@use materials/fields/glsl/cuts.glsl

const bool fieldMixes = true;

vec3 puffOn_(int at) {
  vec4 place = fieldTexel(at), form = fieldTexel(at + 1);
  return puffChord(puffScaled(q_ - place.xyz, form.xyz, form.w, place.w), puffScaled(d_, form.xyz, form.w, place.w));
}

vec2 fieldChord(int at) {
  vec3 chord = puffOn_(at);
  return vec2(chord.x - chord.y, chord.x + chord.y);
}

// Steps are finer near the first puff, the youngest of a trail: as PuffCuts of puffs.cpp.
vec2 puffsScale_ = vec2(0.0, 1.0), puffsEnds_ = vec2(0.0);
void fieldLine(int at, int steps) {
  vec4 head = fieldTexel(0);
  vec3 p = q_ - head.xyz;
  float nearest = -dot(p, d_) / dot(d_, d_);
  vec3 there = p + nearest * d_;
  puffsScale_ = vec2(nearest, perT_ * inversesqrt(dot(there, there) + head.w * head.w));
  puffsEnds_ = vec2(cutSigma(enter_, puffsScale_), cutSigma(leave_, puffsScale_));
}

float fieldCut(float s) { return s <= 0.0 ? enter_ : s >= 1.0 ? leave_ : clamp(cutPlace(mix(puffsEnds_.x, puffsEnds_.y, s), puffsScale_), enter_, leave_); }

void fieldAdd(int at, float from, float to) {
  float column = perT_ * puffColumn(puffOn_(at), from, to);
  if (column <= 0.0) return;
  vec4 amounts = fieldTexel(at + 2) * column, state = fieldTexel(at + 3);
  float weight = amounts.x + amounts.y + amounts.z + amounts.w;
  addTemperature(weight, state.x);
  amountLow_ += amounts;
  weight_ += weight;
  heat_ += weight * state.x;
  gained_ += weight * state.y;
  lit_ += weight * state.z;
  shade_ += weight * state.w;
}
