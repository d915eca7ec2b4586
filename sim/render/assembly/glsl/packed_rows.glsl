// Of a part: a number a node, four to a texel.
layout(binding = 1) uniform samplerBuffer rows;
Real rowAt(int row, int i) { return texelFetch(rows, row + i / 4)[i % 4]; }
