// No light from all around.
void prepareAmbient() {}
Real reflectedAmbient(Real reflectance, int i) { return 0.0; }
