// Textures that multiply reflection, emission or transmission.
//@use sim/render/glsl/textures.glsl
float modifierAt(int texture) { return texture < 0 ? 1.0 : textureValue(texture, uv_); }
