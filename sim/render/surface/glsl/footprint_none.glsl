// Single places of textures, as many as a picture has pixels: what is finer than these is a matter of `samples`.
float textureValue(int texture) { return valueAt(texture, uv_); }
vec3 temperaturesOf(int texture) { return vec3(textureValue(texture)); }
