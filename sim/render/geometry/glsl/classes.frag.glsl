// The class of what each pixel sees, as depth; 1 for what a view of one body leaves out, and for what has been shaded with others.
layout(binding = 0) uniform usampler2D visibility;
//@use sim/radiometry/glsl/ground.glsl
//@constants
layout(binding = 19) uniform sampler2D bends;  // of pixels of grouped x grouped subpixels: 0 where all of these have been shaded
uniform int grouped;  // 0: none
//@use sim/render/geometry/glsl/ray.glsl
// What a pixel's light depends on where the sun alone shines on a Lambertian surface, and 1 / depth, which is even over a plane; else (-1, 0).
layout(location = 0) out vec2 smoothness;
const int kSunAlone = 0, kUnshadowed = 1, kEveryLight = 2;
const float kNextClass = 1.0 / 16.0;  // as PixelClasses::depthOf
//@slot light_demand

void main() {
  uvec2 id = texelFetch(visibility, ivec2(gl_FragCoord.xy), 0).xy;
  if (GROUND >= 0 && id.x == 0u) {
    prepareRay(gl_FragCoord.xy);
    if (groundRange(view.up.w, sinElevation_, view.earth.x) < kFar) id.x = uint(max(GROUND, 0));
  }
  bool leftOut = view.earth.z > 0.0 && float(drawTexel(id.x, 3).w) != view.earth.z;
  if (grouped > 0) leftOut = leftOut || texelFetch(bends, ivec2(gl_FragCoord.xy) / grouped, 0).x == 0.0;
  vec2 own = drawMember(id.x, 5).yz;  // of its class, and that of its class with every light
  int demand = own.x != own.y ? lightDemand(id, gl_FragCoord.xy) : kSunAlone;
  gl_FragDepth = leftOut ? 1.0 : demand == kSunAlone ? own.x : demand == kUnshadowed ? own.x + kNextClass : own.y;
  smoothness = own.x == own.y || !smooth_ ? vec2(-1.0, 0.0) : lightAndDepth_;
}
