// No truth layers.
void writeTruth(float cosPsi) {}
