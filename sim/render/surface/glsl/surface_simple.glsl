// Materials without angular tables and modifiers: reflection columns and self radiance (emission and reflected ambient) of a part
// are one row, made in double precision: (R1, R2, R3, S), (R4, R5, R6, 0) ...
//@use sim/render/assembly/glsl/materials.glsl
//@use sim/render/surface/glsl/lobes.glsl
layout(binding = 1) uniform samplerBuffer rows;

void prepareSurface() {}
Vec3 reflectionColumns(int i, int l, int v) { return texelFetch(rows, (int(draw_.table.x) + i) * COMPONENT_VECTORS + v).xyz; }
Real selfRadiance(int i) { return texelFetch(rows, (int(draw_.table.x) + i) * COMPONENT_VECTORS).w; }
float truthTemperature() { return draw_.state.x; }
//@slot transmission
