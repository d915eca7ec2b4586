// No reflection component is a table over angles: one entry per material and node, the same for every light.
//@use sim/render/glsl/lobes.glsl
layout(binding = 3) uniform samplerBuffer columns;  // (R1, R2, R3), (R4 ... by angle 2, angle 1 and node
Vec3 reflectionColumns(int i, int l, int v) { return texelFetch(columns, int(material_.counts.w) + i * COMPONENT_VECTORS + v).xyz * modifier_[v]; }
