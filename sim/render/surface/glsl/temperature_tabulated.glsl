// Some part has a temperature texture, and nodes are groups of wavelengths: their mean Planck radiance is tabulated over the inverse of the
// temperature. The table begins with the first inverse and entries per inverse.
//@use sim/render/assembly/glsl/textures.glsl
//@use sim/render/assembly/glsl/packed_rows.glsl
vec3 temperatures_;  // two, and the share of the second
float surfaceTemperature() {
  temperatures_ = draw_.table.z > 0u ? temperaturesOf(int(draw_.table.z) - 1) : vec3(draw_.state.x);
  return mix(temperatures_.x, temperatures_.y, draw_.table.z > 0u ? temperatures_.z : 0.0);
}
ivec2 planckEntry_;
vec2 planckMix_;
void prepareTemperature() {
  vec2 scale = texelFetch(rows, PLANCK_AT).xy;
  vec2 at = clamp((1.0 / temperatures_.xy - scale.x) * scale.y, 0.0, float(PLANCK_ENTRIES - 1));
  ivec2 entry = ivec2(min(at, float(PLANCK_ENTRIES - 2)));
  planckMix_ = at - vec2(entry);
  planckEntry_ = PLANCK_AT + 1 + entry * NODE_TEXELS;
}
Real planckAt(int entry, float share, int i) { return mix(rowAt(entry, i), rowAt(entry + NODE_TEXELS, i), share); }
Real sourceRadiance(int i) {
  if (draw_.table.z == 0u) return rowAt(int(draw_.table.x), i);
  Real first = planckAt(planckEntry_.x, planckMix_.x, i);
  return FILTERED == 0 ? first : mix(first, planckAt(planckEntry_.y, planckMix_.y, i), temperatures_.z);
}
