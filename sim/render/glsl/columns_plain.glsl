// No reflection component is a table over angles: one entry per material and node, the same for every light.
//@use sim/render/glsl/lobes.glsl
layout(binding = 3) uniform samplerBuffer columns;  // (R1, R2, R3) by angle 2, angle 1 and node
void prepareLobes() { exponents_ = material_.exponent.xyz; }
Vec3 reflectionColumns(int i, int l) { return texelFetch(columns, int(material_.counts.w) + i).xyz * modifier_.xyz; }
