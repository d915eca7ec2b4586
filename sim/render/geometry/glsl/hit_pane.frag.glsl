// Where a line meets a transparent surface: t along it from the plane of the body's origin, and the triangle.
layout(early_fragment_tests) in;
//@use sim/render/geometry/glsl/ray.glsl
//@slot ground
//@use sim/render/geometry/glsl/hit_list.glsl
uniform int drawIndex;
flat in uint triangle;

void main() {
  prepareRay(gl_FragCoord.xy);
  Draw draw = drawAt(uint(drawIndex));
  float t = meet(triangle, pointOnPlane(draw), inBody(draw, ray_)).along;
  if (!hiddenByGround((planeOf(draw) + t) * rayLength_)) addHit(kPane, uint(drawIndex), uvec3(floatBitsToUint(t), 0u, triangle));
}
