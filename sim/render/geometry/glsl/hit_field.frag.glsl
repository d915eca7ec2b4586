// Between which depths a field may lie on the lines of a pixel, as its tile says.
layout(early_fragment_tests) in;
//@use sim/render/geometry/glsl/volume_ray.glsl
//@use sim/render/geometry/glsl/field_tiles.glsl
//@use sim/render/geometry/glsl/hit_list.glsl
uniform int drawIndex;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  FieldTile tile = fieldTileAt(at);
  if (tile.listed == 0) return;
  prepareRay(gl_FragCoord.xy);
  Draw body = drawAt(uint(drawIndex));
  vec2 range = vec2(max(tile.range.x, -planeOf(body)), min(tile.range.y, endOfRay(body, at)));
  if (range.y > range.x) addHit(kField, uint(drawIndex), uvec3(floatBitsToUint(range), 0u));
}
