// No reflection component is a table over angles: one entry per material and node, the same for every light.
//@use sim/render/surface/glsl/lobes.glsl
layout(binding = 3) uniform samplerBuffer columns;  // (R1, R2, R3), (R4 ... by angle 2, angle 1 and node
Vec3 reflectionColumns(int i, int l, int v) {
  int each = NODES * COMPONENT_VECTORS, at = int(material_.counts.w) + state_ * each + i * COMPONENT_VECTORS + v;
  vec3 column = texelFetch(columns, at).xyz;
  if (STATES > 0) column = mix(column, texelFetch(columns, at + nextState(each)).xyz, stateMix_);
  return column * modifier_[v];
}
