// Entries of a list as fragments: 256 to a point of 16 x 16, the rest of a list in points of 4 x 4. Points go round the tiles of 64 x 64, so that a short list
// keeps all threads busy.
uniform int listFirst;  // of those that are drawn
uniform int listCount;
flat out ivec2 batch;  // first entry, entries
//@use sim/render/media/glsl/listed_place.glsl

void main() {
  int full = listCount >> 8, number = min(gl_VertexID, full), own = gl_VertexID < full ? 0 : 16 * (gl_VertexID - full);
  batch = ivec2(listFirst + 256 * number, listCount - 256 * number);
  float size = gl_VertexID < full ? 16.0 : 4.0;
  gl_Position = vec4((vec2(batchCorner(number) + inBatch(own)) + 0.5 * size) * (2.0 / kListSide) - 1.0, 0.5, 1.0);
  gl_PointSize = size;
}
