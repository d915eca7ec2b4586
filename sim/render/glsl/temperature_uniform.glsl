// Each part has one temperature: its Planck radiance was made in double precision.
float surfaceTemperature() { return draw_.state.x; }
void prepareTemperature() {}
Real sourceRadiance(int i) { return texelFetch(rows, int(draw_.table.x) + i).x; }
