// The solid scene as compute: one invocation a pixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform usampler2D visibility;
layout(binding = 18) uniform sampler2D classes;
uniform ivec4 part;  // corner and size
uniform float classDepth;
uniform bool below;  // all classes below that depth
//@use sim/render/surface/glsl/shading.glsl
//@slot store

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, part.zw))) return;
  at += part.xy;
  float own = texelFetch(classes, at, 0).x;
  if (below ? own >= classDepth : own != classDepth) return;
  uvec2 id = texelFetch(visibility, at, 0).xy;
  lookAt(id, vec2(at) + 0.5);
  clearTargets();
  integrate();
  writeTruth(1.0 / rayLength_);
  storeTargets(at);
}
