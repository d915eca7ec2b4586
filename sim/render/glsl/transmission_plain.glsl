// Transmittance that is the same at all view angles and places.
//@use sim/render/glsl/materials.glsl
layout(binding = 4) uniform samplerBuffer transmittances;
Real transmittance(int i) { return texelFetch(transmittances, materials[draw_.table.y].transmission.y + i).x; }
Real transmittanceLost(int i) { return 0.0; }
