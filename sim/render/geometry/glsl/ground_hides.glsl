//@use sim/radiometry/glsl/ground.glsl
// Where a line of sight that meets no body goes down the ground ends it: what lies farther is not seen.
layout(binding = 0) uniform usampler2D visibility;

bool hiddenByGround(float range) {
  return texelFetch(visibility, ivec2(gl_FragCoord.xy), 0).x == 0u && range > groundRange(view.up.w, sinElevation_, view.earth.x);
}
