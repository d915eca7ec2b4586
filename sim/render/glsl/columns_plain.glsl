// No reflection component is a table over angles: one entry per material and node, the same for every light.
Vec3 reflectionColumns(int i, int l) { return texelFetch(columns, int(material_.counts.w) + i).xyz * modifier_.xyz; }
