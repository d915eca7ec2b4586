//@constants
// What a pixel of GROUPED x GROUPED subpixels sees near its middle, of what these see, and its depth.
layout(location = 0) out uvec2 identity;
layout(binding = 0) uniform usampler2D visibility;
layout(binding = 18) uniform sampler2D depths;

void main() {
  ivec2 middle = GROUPED * ivec2(gl_FragCoord.xy) + GROUPED / 2;
  identity = texelFetch(visibility, middle, 0).xy;
  gl_FragDepth = texelFetch(depths, middle, 0).x;
}
