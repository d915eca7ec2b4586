// What a pixel of grouped x grouped subpixels sees near its middle, of what these see.
layout(location = 0) out uvec2 identity;
layout(binding = 0) uniform usampler2D visibility;
uniform int grouped;

void main() { identity = texelFetch(visibility, grouped * ivec2(gl_FragCoord.xy) + grouped / 2, 0).xy; }
