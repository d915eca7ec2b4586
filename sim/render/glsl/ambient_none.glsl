// No light from all around.
Real reflectedAmbient(Real reflectance, int i) { return 0.0; }
