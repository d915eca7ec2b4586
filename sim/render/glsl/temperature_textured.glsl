// Some part has a temperature texture: Planck's law per fragment there.
//@use sim/render/glsl/textures.glsl
float surfaceTemperature() { return draw_.table.z > 0u ? textureValue(int(draw_.table.z) - 1, uv_) : draw_.state.x; }
void prepareTemperature() {}
Real sourceRadiance(int i) {
  return draw_.table.z == 0u ? texelFetch(rows, int(draw_.table.x) + i).x : planckFromConstants(nodes.node[i].z, nodes.node[i].w, temperature_);
}
