// Layers that neither emit nor reflect.
//@use sim/render/assembly/glsl/materials.glsl
void prepareSurface() {}
Real selfRadiance(int i) { return 0.0; }
float truthTemperature() { return 0.0; }
//@slot transmission
