// Surfaces as in surface_simple.glsl on which nothing shines: a row is what they send of themselves.
layout(binding = 1) uniform samplerBuffer rows;

void prepareSurface() {}
Real selfRadiance(int i) { return texelFetch(rows, int(draw_.table.x) + i).x; }
float truthTemperature() { return draw_.state.x; }
//@slot transmission
