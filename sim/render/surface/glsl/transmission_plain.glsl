// Transmittance that is the same at all view angles and places.
//@use sim/render/assembly/glsl/materials.glsl
layout(binding = 4) uniform samplerBuffer transmittances;
Real transmittance(int i) { return texelFetch(transmittances, int(materialTexel(draw_.table.y, 3).y) + i).x; }
Real transmittanceLost(int i) { return 0.0; }
