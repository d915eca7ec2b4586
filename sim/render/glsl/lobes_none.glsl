// No component has an angular lobe.
Real lobe(Real exponent, Vec3 normal, Vec3 toLight, Vec3 toViewer) { return 1.0; }
