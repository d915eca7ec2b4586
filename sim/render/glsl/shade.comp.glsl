// The solid scene as compute: one invocation a pixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform usampler2D visibility;
//@use sim/render/glsl/shading.glsl
//@slot store

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, textureSize(visibility, 0)))) return;
  uvec2 id = texelFetch(visibility, at, 0).xy;
  if (view.earth.z > 0.0 && float(draws[id.x].table.w) != view.earth.z) return;
  lookAt(id, vec2(at) + 0.5);
  clearTargets();
  integrate();
  writeTruth(1.0 / rayLength_);
  storeTargets(at);
}
