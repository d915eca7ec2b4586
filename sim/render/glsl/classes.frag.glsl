// The class of what each pixel sees, as depth; 1 for what a view of one body leaves out.
layout(binding = 0) uniform usampler2D visibility;
//@use sim/radiometry/glsl/ground.glsl
//@constants
//@use sim/render/glsl/ray.glsl

void main() {
  uvec2 id = texelFetch(visibility, ivec2(gl_FragCoord.xy), 0).xy;
  if (GROUND >= 0 && id.x == 0u) {
    prepareRay(gl_FragCoord.xy);
    if (groundRange(view.up.w, sinElevation_, view.earth.x) < kFar) id.x = uint(max(GROUND, 0));
  }
  bool leftOut = view.earth.z > 0.0 && float(drawTexel(id.x, 3).w) != view.earth.z;
  gl_FragDepth = leftOut ? 1.0 : drawMember(id.x, 5).y;
}
