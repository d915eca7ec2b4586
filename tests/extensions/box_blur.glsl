// Mean over a square of cells around each: parameters[0] cells to each side.
float stageAt(ivec2 at) {
  int reach = int(parameters[0]);
  float sum = 0.0;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) sum += cell(at + ivec2(x, y));
  return sum / float((2 * reach + 1) * (2 * reach + 1));
}
