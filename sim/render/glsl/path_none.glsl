// No air.
Real airLength(Real height_m, Real sinElevation, Real range_m) { return 0.0; }
Real sunAirLength(Real height_m) { return 0.0; }
Real pathTransmittance(int i, Real length_m) { return 1.0; }
Real pathRadiance(int i, Real length_m) { return 0.0; }
Real pathDepth(int i, Real before_m, Real length_m) { return 0.0; }
Real pathSeen(int i, Real radiance) { return radiance; }
