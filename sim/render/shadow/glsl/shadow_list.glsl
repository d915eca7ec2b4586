// Casters that may stand between a point and a light, as shadow_maps.glsl has them, and which of them cannot.
layout(binding = 13) uniform usamplerBuffer shadows;
layout(binding = 15) uniform usamplerBuffer clearFacets;  // a bit for each triangle: nothing of its body shades it from the sun

uvec4 shadowTexel(int number, int member) { return texelFetch(shadows, 10 * number + member); }
vec4 shadowRow(int number, int member) { return uintBitsToFloat(shadowTexel(number, member)); }

// Facets that face the whole sun and that what stands still leaves clear, seen from their outside.
bool isClear_;
void prepareClear(vec3 toLight) {
  isClear_ = wholeSun_ && dot(facet_, toViewer_) >= 0.0 && dot(facet_, toLight) >= 0.0 &&
             (texelFetch(clearFacets, int(triangle_ >> 5)).x >> (triangle_ & 31u) & 1u) != 0u;
}

// False where a caster cannot stand before the light: its ball beside the line or behind, or it stands still and leaves the facet clear.
bool mayStop(int number, vec3 toLight) {
  vec4 ball = shadowRow(number, 9);
  vec3 to = ball.xyz - point_;
  // The difference itself, not that of its squares: of a caster far off these would have lost all digits of its size. With room for the rounding of both.
  float along = dot(to, toLight), reach = ball.w * 1.0001 + 4.0e-6 * length(to);
  vec3 beside = to - along * toLight;
  bool leavesClear = shadowTexel(number, 7).w >= 8u;  // the facets that are marked
  return !(leavesClear && isClear_) && along >= -reach && dot(beside, beside) <= reach * reach;
}

// listed: of a body's row of lights, (light, first caster, casters).
bool mayBeHidden(vec4 listed, vec3 toLight) {
  int first = int(listed.y), last = first + int(listed.z);
  prepareClear(toLight);
  bool may = false;
  for (int k = first; k < last; ++k) may = may || mayStop(k, toLight);
  return may;
}
