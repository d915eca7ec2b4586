// A uniform dome lights all surfaces.
void prepareAmbient() {}
Real reflectedAmbient(Real reflectance, int i) { return isSurface_ * reflectance * nodes.nodeAmbient[i].x; }
