// Textures of floats in one buffer, read bilinearly in single precision (hardware filters use 8-bit fractions).
layout(std430, binding = 8) readonly buffer TextureShapes { uvec4 textureShapes[]; };  // first texel, width, height, repeats
layout(std430, binding = 9) readonly buffer Texels { float texels[]; };

float textureValue(int texture, vec2 uv) {
  uvec4 shape = textureShapes[texture];
  vec2 size = vec2(shape.yz);
  vec2 at = uv * size - 0.5;
  vec2 cell = floor(at);
  vec2 f = at - cell;
  ivec2 extent = ivec2(shape.yz);
  ivec2 a = ivec2(shape.w == 1u ? mod(cell, size) : cell), b = ivec2(shape.w == 1u ? mod(cell + 1.0, size) : cell + 1.0);
  a = clamp(a, ivec2(0), extent - 1);
  b = clamp(b, ivec2(0), extent - 1);
  float t00 = texels[shape.x + uint(a.y * extent.x + a.x)], t10 = texels[shape.x + uint(a.y * extent.x + b.x)];
  float t01 = texels[shape.x + uint(b.y * extent.x + a.x)], t11 = texels[shape.x + uint(b.y * extent.x + b.x)];
  return mix(mix(t00, t10, f.x), mix(t01, t11, f.x), f.y);
}
