// One program a class.
vec2 lightAndDepth_;
bool smooth_;
bool needsAll(uvec2 id, vec2 pixel) { return false; }
