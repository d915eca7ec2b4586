// Surfaces as in surface_simple.glsl on which nothing shines: a row is what they send of themselves.
//@use sim/render/assembly/glsl/packed_rows.glsl

void prepareSurface() {}
Real selfRadiance(int i) { return rowAt(int(draw_.table.x), i); }
float truthTemperature() { return draw_.state.x; }
//@slot transmission
