// One program a class.
bool needsAll(uvec2 id, vec2 pixel) { return false; }
