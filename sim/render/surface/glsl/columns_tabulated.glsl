// Some reflection component is a table over one or two angles: linear between its entries, for each light. Components over other angles than the first
// table's stand in a second; each is 0 in the table that is not its own.
//@use sim/render/surface/glsl/lobes.glsl
layout(binding = 3) uniform samplerBuffer columns;  // (R1, R2, R3), (R4 ... by angle 2, angle 1 and node

float angleOf(uint kind, Vec3 l) {
  if (kind == 1u) return angleFromChord(normal_, l);
  if (kind == 2u) return angleFromChord(normal_, toViewer_);
  if (kind == 3u) return angleFromChord(reflect(-l, normal_), toViewer_);
  if (kind == 4u) return angleFromChord(normal_, normalize(l + toViewer_));
  if (kind == 5u) return angleFromChord(l, normalize(l + toViewer_));
  if (kind == 6u) return sqrt(angleFromChord(normal_, normalize(l + toViewer_)) * 1.57079632679490);
  return 0.0;
}

// `first`: of the table, at node 0; `own`: the node's and vector's place in a row.
vec3 columnOf(uvec2 kinds, uvec2 counts, vec2 scale, int first, int own, Vec3 l) {
  float x = 0.0, y = 0.0;
  if (kinds.x != 0u) x = clamp(angleOf(kinds.x, l) * scale.x, 0.0, float(counts.x - 1u));
  if (kinds.y != 0u) y = clamp(angleOf(kinds.y, l) * scale.y, 0.0, float(counts.y - 1u));
  int nx = int(counts.x), ny = int(counts.y);
  int jx = min(int(x), max(nx, 2) - 2), jy = min(int(y), max(ny, 2) - 2);
  float fx = x - float(jx), fy = y - float(jy);
  int row = NODES * COMPONENT_VECTORS, sx = nx > 1 ? row : 0, sy = ny > 1 ? nx * row : 0;
  int each = nx * ny * row, at = first + state_ * each + (jy * nx + jx) * row + own;
  vec3 low = mix(texelFetch(columns, at).xyz, texelFetch(columns, at + sx).xyz, fx);
  vec3 high = mix(texelFetch(columns, at + sy).xyz, texelFetch(columns, at + sx + sy).xyz, fx);
  vec3 column = mix(low, high, fy);
  if (STATES > 0) {
    at += nextState(each);
    low = mix(texelFetch(columns, at).xyz, texelFetch(columns, at + sx).xyz, fx);
    high = mix(texelFetch(columns, at + sy).xyz, texelFetch(columns, at + sx + sy).xyz, fx);
    column = mix(column, mix(low, high, fy), stateMix_);
  }
  return column;
}

Vec3 reflectionColumns(int i, int l, int v) {
  int own = i * COMPONENT_VECTORS + v;
  vec3 column = columnOf(material_.kinds.xy, material_.counts.xy, material_.scale.xy, int(material_.counts.w), own, toLight(l));
  if (COLUMN_TABLES > 1 && material_.second.x > 1u)
    column += columnOf(uvec2(material_.second.z & 7u, material_.second.z >> 3u), material_.second.xy, material_.stateScale.zw, int(material_.second.w), own,
                       toLight(l));
  return column * modifier_[v];
}
