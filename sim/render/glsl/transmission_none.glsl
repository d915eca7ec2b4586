// Opaque surfaces.
Real transmittance(int i) { return 0.0; }
