// What of a field the lines of a pixel may meet. Of each tile: first of its list of elements, length, steps of its lines, between which depths they lie
// (floats: t from the plane of the field's origin).
layout(binding = 19) uniform usamplerBuffer fieldTiles;
uniform ivec4 tileGrid;  // first pixel x, y; tiles across; pixels a side

struct FieldTile {
  int list, listed, steps;
  vec2 range;
};
FieldTile fieldTileAt(ivec2 pixel) {
  ivec2 tile = (pixel - tileGrid.xy) / tileGrid.w;
  int row = 5 * (tile.y * tileGrid.z + tile.x);
  return FieldTile(int(texelFetch(fieldTiles, row).x), int(texelFetch(fieldTiles, row + 1).x), int(texelFetch(fieldTiles, row + 2).x),
                   uintBitsToFloat(uvec2(texelFetch(fieldTiles, row + 3).x, texelFetch(fieldTiles, row + 4).x)));
}
