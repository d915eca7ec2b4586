// Where entries of a list are drawn: batches of 16 x 16 fragments, sixteen of them to a tile of 64 x 64, 4 x 4 fragments after each other.
const float kListSide = 1024.0;
ivec2 batchCorner(int batch) {
  int tile = batch & 255, own = batch >> 8;
  return 64 * ivec2(tile & 15, tile >> 4) + 16 * ivec2(own & 3, own >> 2);
}
ivec2 inBatch(int own) {
  int four = own >> 4;
  return ivec2((four & 3) * 4 + (own & 3), (four >> 2) * 4 + ((own >> 2) & 3));
}
