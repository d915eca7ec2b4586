// Some part has a temperature texture, and nodes are groups of wavelengths: their mean Planck radiance is tabulated over the inverse of the
// temperature. The table begins with the first inverse and entries per inverse.
//@use sim/render/glsl/textures.glsl
//@use sim/render/glsl/packed_rows.glsl
float surfaceTemperature() { return draw_.table.z > 0u ? textureValue(int(draw_.table.z) - 1, uv_) : draw_.state.x; }
int planckEntry_;
float planckMix_;
void prepareTemperature() {
  vec2 scale = texelFetch(rows, PLANCK_AT).xy;
  float at = clamp((1.0 / temperature_ - scale.x) * scale.y, 0.0, float(PLANCK_ENTRIES - 1));
  int entry = int(min(at, float(PLANCK_ENTRIES - 2)));
  planckMix_ = at - float(entry);
  planckEntry_ = PLANCK_AT + 1 + entry * NODE_TEXELS;
}
Real sourceRadiance(int i) {
  if (draw_.table.z == 0u) return rowAt(int(draw_.table.x), i);
  return mix(rowAt(planckEntry_, i), rowAt(planckEntry_ + NODE_TEXELS, i), planckMix_);
}
