// Lines through the pixels that fields show in: of each pixel of a part of the film, row by row, where its lines are told (0: it has none): their number, the
// share of the pixel that they leave (a float), then of each its place on the film [pixels] and its share (floats).
layout(binding = 16) uniform usamplerBuffer fieldLines;
uniform ivec4 linesPart;  // corner, size

int linesOf(ivec2 pixel) {
  ivec2 at = pixel - linesPart.xy;
  if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, linesPart.zw))) return 0;
  return int(texelFetch(fieldLines, at.y * linesPart.z + at.x).x);
}
int countOfLines(int lines) { return lines == 0 ? 0 : int(texelFetch(fieldLines, lines).x); }
float leftByLines(int lines) { return lines == 0 ? 1.0 : uintBitsToFloat(texelFetch(fieldLines, lines + 1).x); }
vec2 placeOfLine(int lines, int l) { return uintBitsToFloat(uvec2(texelFetch(fieldLines, lines + 2 + 3 * l).x, texelFetch(fieldLines, lines + 3 + 3 * l).x)); }
float shareOfLine(int lines, int l) { return uintBitsToFloat(texelFetch(fieldLines, lines + 4 + 3 * l).x); }
