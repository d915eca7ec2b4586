// Some part has a temperature texture, and nodes are groups of wavelengths: their mean Planck radiance is tabulated over the inverse of the
// temperature. The table begins with the first inverse and entries per inverse.
//@use sim/render/glsl/textures.glsl
float surfaceTemperature() { return draw_.table.z > 0u ? textureValue(int(draw_.table.z) - 1, uv_) : draw_.state.x; }
int planckEntry_;
float planckMix_;
void prepareTemperature() {
  float at = clamp((1.0 / temperature_ - texelFetch(rows, PLANCK_AT).x) * texelFetch(rows, PLANCK_AT + 1).x, 0.0, float(PLANCK_ENTRIES - 1));
  int entry = int(min(at, float(PLANCK_ENTRIES - 2)));
  planckMix_ = at - float(entry);
  planckEntry_ = PLANCK_AT + 2 + entry * NODES;
}
Real sourceRadiance(int i) {
  if (draw_.table.z == 0u) return texelFetch(rows, int(draw_.table.x) + i).x;
  return mix(texelFetch(rows, planckEntry_ + i).x, texelFetch(rows, planckEntry_ + NODES + i).x, planckMix_);
}
