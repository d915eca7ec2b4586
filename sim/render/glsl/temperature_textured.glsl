// Some part has a temperature texture: Planck's law per fragment there.
Real sourceRadiance(int i) {
  return draw_.table.z == 0u ? rows[draw_.table.x + uint(i)] : planckFromConstants(nodes.node[i].z, nodes.node[i].w, temperature_);
}
