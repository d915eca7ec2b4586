// What every program knows of the wavelengths.
layout(std140, binding = 1) uniform NodeBlock {
  vec4 node[NODES];                    // extinction [1/m], air source radiance, c2 / lambda [K], c1L / lambda^5
  vec4 nodeLight[NODES * LIGHT_GROUPS];  // intensity of four lights at a node [W/(sr um)], the sun as irradiance
  vec4 nodeAmbient[NODES];
} nodes;
