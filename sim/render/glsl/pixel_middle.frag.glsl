// What a pixel of grouped x grouped subpixels sees near its middle, of what these see, and its depth.
layout(location = 0) out uvec2 identity;
layout(binding = 0) uniform usampler2D visibility;
layout(binding = 18) uniform sampler2D depths;
uniform int grouped;

void main() {
  ivec2 middle = grouped * ivec2(gl_FragCoord.xy) + grouped / 2;
  identity = texelFetch(visibility, middle, 0).xy;
  gl_FragDepth = texelFetch(depths, middle, 0).x;
}
