// What the lines of a picture meet that is seen through, as the rasteriser finds it: a chain of hits for each line.
//@use sim/render/geometry/glsl/hit_kinds.glsl
layout(std430, binding = 4) buffer Heads { uint heads[]; };     // of each pixel: 1 + the hit found last
layout(std430, binding = 5) writeonly buffer Hits { uvec4 hits[]; };
layout(std430, binding = 6) writeonly buffer Links { uvec4 links[]; };  // x: 1 + the next hit of the line
layout(std430, binding = 7) writeonly buffer Lines { uint lines[]; };   // pixels that have any
layout(std430, binding = 8) buffer Totals { uint totals[]; };           // hits, lines
uniform int filmWidth;
uniform int hitRoom;

void addHit(uint kind, uint draw, uvec3 more) {
  uint x = uint(gl_FragCoord.x), y = uint(gl_FragCoord.y), at = atomicAdd(totals[0], 1u);
  if (at >= uint(hitRoom)) return;
  hits[at] = uvec4(kind << 30 | draw, more);
  uint next = atomicExchange(heads[y * uint(filmWidth) + x], at + 1u);
  links[at] = uvec4(next, 0u, 0u, 0u);
  if (next == 0u) lines[atomicAdd(totals[1], 1u)] = x | y << 16;
}
