// No clouds of drops stand before the sun.
void prepareSunShade() {}
Real sunShade(int i) { return 1.0; }
