// Some reflection component is a table over one or two angles: linear between its entries, for each light.
//@use sim/render/glsl/lobes.glsl
layout(binding = 3) uniform samplerBuffer columns;  // (R1, R2, R3), (R4 ... by angle 2, angle 1 and node

float angleOf(uint kind, Vec3 l) {
  if (kind == 1u) return angleFromChord(normal_, l);
  if (kind == 2u) return angleFromChord(normal_, toViewer_);
  if (kind == 3u) return angleFromChord(reflect(-l, normal_), toViewer_);
  if (kind == 4u) return angleFromChord(normal_, normalize(l + toViewer_));
  if (kind == 5u) return angleFromChord(l, normalize(l + toViewer_));
  return 0.0;
}

Vec3 reflectionColumns(int i, int l, int v) {
  float x = 0.0, y = 0.0;
  if (material_.kinds.x != 0u) x = clamp(angleOf(material_.kinds.x, toLight(l)) * material_.scale.x, 0.0, float(material_.counts.x - 1u));
  if (material_.kinds.y != 0u) y = clamp(angleOf(material_.kinds.y, toLight(l)) * material_.scale.y, 0.0, float(material_.counts.y - 1u));
  int nx = int(material_.counts.x), ny = int(material_.counts.y);
  int jx = min(int(x), max(nx, 2) - 2), jy = min(int(y), max(ny, 2) - 2);
  float fx = x - float(jx), fy = y - float(jy);
  int row = NODES * COMPONENT_VECTORS, sx = nx > 1 ? row : 0, sy = ny > 1 ? nx * row : 0;
  int each = nx * ny * row, at = int(material_.counts.w) + state_ * each + (jy * nx + jx) * row + i * COMPONENT_VECTORS + v;
  vec3 low = mix(texelFetch(columns, at).xyz, texelFetch(columns, at + sx).xyz, fx);
  vec3 high = mix(texelFetch(columns, at + sy).xyz, texelFetch(columns, at + sx + sy).xyz, fx);
  vec3 column = mix(low, high, fy);
  if (STATES > 0) {
    at += nextState(each);
    low = mix(texelFetch(columns, at).xyz, texelFetch(columns, at + sx).xyz, fx);
    high = mix(texelFetch(columns, at + sy).xyz, texelFetch(columns, at + sx + sy).xyz, fx);
    column = mix(column, mix(low, high, fy), stateMix_);
  }
  return column * modifier_[v];
}
