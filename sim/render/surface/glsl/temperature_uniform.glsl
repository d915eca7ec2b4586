// Each part has one temperature: its Planck radiance was made in double precision.
//@use sim/render/assembly/glsl/packed_rows.glsl
float surfaceTemperature() { return draw_.state.x; }
void prepareTemperature() {}
Real sourceRadiance(int i) { return rowAt(int(draw_.table.x), i); }
