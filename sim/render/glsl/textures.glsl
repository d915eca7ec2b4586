// Textures of floats in one buffer, read bilinearly in single precision (hardware filters use 8-bit fractions).
layout(binding = 11) uniform usamplerBuffer textureShapes;  // first texel, width, height, repeats
layout(binding = 12) uniform samplerBuffer texels;
float texelAt(int at) { return texelFetch(texels, at).x; }

float textureValue(int texture, vec2 uv) {
  ivec4 shape = ivec4(texelFetch(textureShapes, texture));
  vec2 size = vec2(shape.yz);
  vec2 at = uv * size - 0.5;
  vec2 cell = floor(at);
  vec2 f = at - cell;
  ivec2 extent = shape.yz;
  ivec2 a = ivec2(shape.w == 1 ? mod(cell, size) : cell), b = ivec2(shape.w == 1 ? mod(cell + 1.0, size) : cell + 1.0);
  a = clamp(a, ivec2(0), extent - 1);
  b = clamp(b, ivec2(0), extent - 1);
  int low = shape.x + a.y * extent.x, high = shape.x + b.y * extent.x;
  float t00 = texelAt(low + a.x), t10 = texelAt(low + b.x), t01 = texelAt(high + a.x), t11 = texelAt(high + b.x);
  return mix(mix(t00, t10, f.x), mix(t01, t11, f.x), f.y);
}
