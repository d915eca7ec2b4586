// Some part has a temperature texture: Planck's law per fragment there.
void prepareTemperature() {}
Real sourceRadiance(int i) {
  return draw_.table.z == 0u ? texelFetch(rows, int(draw_.table.x) + i).x : planckFromConstants(nodes.node[i].z, nodes.node[i].w, temperature_);
}
