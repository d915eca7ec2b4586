// What every program knows of the wavelengths.
layout(std140, binding = 1) uniform NodeBlock {
  vec4 node[NODES];                    // extinction [1/m], air source radiance, c2 / lambda [K], c1L / lambda^5
//@slot light_nodes
//@slot ambient_nodes
} nodes;
