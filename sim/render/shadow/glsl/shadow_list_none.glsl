// Nothing casts shadows.
bool mayBeHidden(vec4 listed, vec3 toLight) { return false; }
