// Meshes of the scene: per vertex (position, u), (normal, v); three indices a triangle, each a texel.
layout(binding = 6) uniform samplerBuffer vertices;
layout(binding = 7) uniform usamplerBuffer indices;
