// The class of what each subpixel sees of those pixels that are not shaded once, as depth; 1 for all others. They need what pixel_bends.frag.glsl says.
layout(binding = 0) uniform usampler2D visibility;
//@use sim/radiometry/glsl/ground.glsl
//@constants
//@use sim/render/geometry/glsl/ray.glsl
//@use sim/render/geometry/glsl/class_depth.glsl
layout(binding = 19) uniform sampler2D bends;  // of pixels of grouped x grouped subpixels
uniform int grouped;

void main() {
  uint draw = drawSeen(texelFetch(visibility, ivec2(gl_FragCoord.xy), 0).x);
  int need = int(texelFetch(bends, ivec2(gl_FragCoord.xy) / grouped, 0).x) - 1;
  gl_FragDepth = need < 0 ? 1.0 : depthOfClass(classesOf(draw), needOf(draw, need));
}
