// No texture multiplies anything.
float modifierAt(int texture) { return 1.0; }
float modifierOf(int component, float last) { return 1.0; }
