// Layers that neither emit nor reflect.
//@use sim/render/glsl/materials.glsl
void prepareSurface() {}
Vec3 reflectionColumns(int i, int l) { return Vec3(0.0); }
Real selfRadiance(int i) { return 0.0; }
float truthTemperature() { return 0.0; }
//@slot transmission
