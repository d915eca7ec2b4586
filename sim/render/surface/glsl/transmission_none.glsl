// Opaque surfaces.
Real transmittance(int i) { return 0.0; }
Real transmittanceLost(int i) { return 0.0; }
