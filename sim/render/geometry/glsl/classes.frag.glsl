// The class of what each pixel sees, as depth; 1 for what a view of one body leaves out.
layout(binding = 0) uniform usampler2D visibility;
//@use sim/radiometry/glsl/ground.glsl
//@constants
//@use sim/render/geometry/glsl/ray.glsl
//@use sim/render/geometry/glsl/class_depth.glsl
// What a pixel's light depends on where the sun alone shines on a Lambertian surface, and 1 / depth, which is even over a plane; else (-1, 0). What it needs.
layout(location = 0) out vec4 smoothness;
//@slot light_demand

void main() {
  uvec2 id = texelFetch(visibility, ivec2(gl_FragCoord.xy), 0).xy;
  id.x = drawSeen(id.x);
  bool leftOut = view.earth.z > 0.0 && float(drawTexel(id.x, 3).w) != view.earth.z;
  vec2 own = classesOf(id.x);
  int demand = own.x != own.y ? lightDemand(id, gl_FragCoord.xy) : kSunAlone;
  gl_FragDepth = leftOut ? 1.0 : depthOfClass(own, demand);
  smoothness = vec4(own.x == own.y || !smooth_ ? vec2(-1.0, 0.0) : lightAndDepth_, float(demand), 0.0);
}
