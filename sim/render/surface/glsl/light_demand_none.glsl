// One program a class.
vec2 lightAndDepth_;
bool smooth_;
int lightDemand(uvec2 id, vec2 pixel) { return kSunAlone; }
