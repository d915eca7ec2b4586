// The solid scene of one class: what the visibility pass found, once per pixel, into the channels (direct) or the spectral image (buffered).
layout(binding = 0) uniform usampler2D visibility;
//@use sim/render/surface/glsl/shading.glsl

void main() {
  uvec2 id = texelFetch(visibility, ivec2(gl_FragCoord.xy), 0).xy;
  lookAt(id, gl_FragCoord.xy);
  clearTargets();
  integrate();
  writeTruth(1.0 / rayLength_);
}
