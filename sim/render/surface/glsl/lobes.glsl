// What light asks of a surface besides its columns: the angular lobes of three of its components for a light.
Vec3 lobes(Vec3 toLight, int v) {
  Vec3 all = Vec3(1.0);
  if (LOBES > 0)
    for (int k = 0; k < 3; ++k) {
      int lobe = componentOf(draw_.table.y, 3 * v + k).x;
      if (lobe > 0) all[k] = lobeOf(lobe, lobeOfComponent(draw_.table.y, 3 * v + k), toLight);
    }
  return all;
}
