// No texture multiplies anything.
float modifierAt(int texture) { return 1.0; }
