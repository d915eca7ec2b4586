// Some part has a temperature texture: Planck's law per fragment there.
//@use sim/render/assembly/glsl/textures.glsl
//@use sim/render/assembly/glsl/packed_rows.glsl
vec3 temperatures_;  // two, and the share of the second
float surfaceTemperature() {
  temperatures_ = draw_.table.z > 0u ? temperaturesOf(int(draw_.table.z) - 1) : vec3(draw_.state.x);
  return mix(temperatures_.x, temperatures_.y, draw_.table.z > 0u ? temperatures_.z : 0.0);
}
void prepareTemperature() {}
Real sourceRadiance(int i) {
  if (draw_.table.z == 0u) return rowAt(int(draw_.table.x), i);
  Real first = planckFromConstants(nodes.node[i].z, nodes.node[i].w, temperatures_.x);
  return FILTERED == 0 ? first : mix(first, planckFromConstants(nodes.node[i].z, nodes.node[i].w, temperatures_.y), temperatures_.z);
}
