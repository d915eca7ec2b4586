// Some part has a temperature texture: Planck's law per fragment there.
//@use sim/render/glsl/textures.glsl
//@use sim/render/glsl/packed_rows.glsl
float surfaceTemperature() { return draw_.table.z > 0u ? textureValue(int(draw_.table.z) - 1, uv_) : draw_.state.x; }
void prepareTemperature() {}
Real sourceRadiance(int i) {
  return draw_.table.z == 0u ? rowAt(int(draw_.table.x), i) : planckFromConstants(nodes.node[i].z, nodes.node[i].w, temperature_);
}
