// Textures that multiply reflection, emission or transmission.
//@use sim/render/assembly/glsl/textures.glsl
float modifierAt(int texture) { return texture < 0 ? 1.0 : textureValue(texture); }
// Of a component, from that of the one before.
float modifierOf(int component, float last) {
  ivec4 own = componentOf(draw_.table.y, component);
  float read = modifierAt(own.w == 1 ? -1 : own.y);
  vec2 image = imageOfComponent(draw_.table.y, component);
  return own.w == 1 ? image.x * last + image.y : read;
}
