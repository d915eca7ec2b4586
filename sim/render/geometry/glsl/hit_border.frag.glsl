// Where a line crosses the surface of a meshed medium, into it or out of it; what lies behind the line's end counts as there.
layout(early_fragment_tests) in;
//@use sim/render/geometry/glsl/volume_ray.glsl
//@use sim/render/geometry/glsl/hit_list.glsl
uniform int drawIndex;
flat in uint triangle;

void main() {
  prepareRay(gl_FragCoord.xy);
  Draw body = drawAt(uint(drawIndex));
  Meeting m = meet(triangle, pointOnPlane(body), inBody(body, ray_));
  float t = min(m.along, endOfRay(body, ivec2(gl_FragCoord.xy)));
  addHit(kBorder, uint(drawIndex), uvec3(floatBitsToUint(t), gl_FrontFacing ? 0u : 1u, triangle));
}
