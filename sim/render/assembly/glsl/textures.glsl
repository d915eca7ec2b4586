// Textures of floats in one buffer, read bilinearly in single precision (hardware filters use 8-bit fractions).
layout(binding = 11) uniform usamplerBuffer textureShapes;  // first texel, width, height; of a texture 1 where it repeats + 2 levels + 64 first level's shape
layout(binding = 12) uniform samplerBuffer texels;
float texelAt(int at) { return texelFetch(texels, at).x; }

// The four texels about a place [texels from the lower left].
struct Corners {
  ivec4 texel;
  vec2 f;
};
Corners cornersOf(ivec4 shape, bool repeats, vec2 place) {
  vec2 size = vec2(shape.yz);
  vec2 at = place - 0.5;
  vec2 cell = floor(at);
  ivec2 extent = shape.yz;
  ivec2 a = ivec2(repeats ? mod(cell, size) : cell), b = ivec2(repeats ? mod(cell + 1.0, size) : cell + 1.0);
  a = clamp(a, ivec2(0), extent - 1);
  b = clamp(b, ivec2(0), extent - 1);
  int low = shape.x + a.y * extent.x, high = shape.x + b.y * extent.x;
  return Corners(ivec4(low + a.x, low + b.x, high + a.x, high + b.x), at - cell);
}
vec4 texelsAt(ivec4 at) { return vec4(texelAt(at.x), texelAt(at.y), texelAt(at.z), texelAt(at.w)); }
float bilinear(vec4 t, vec2 f) { return mix(mix(t.x, t.y, f.x), mix(t.z, t.w, f.x), f.y); }

float valueAt(int texture, vec2 uv) {
  ivec4 shape = ivec4(texelFetch(textureShapes, texture));
  Corners c = cornersOf(shape, (shape.w & 1) == 1, uv * vec2(shape.yz));
  return bilinear(texelsAt(c.texel), c.f);
}
//@slot footprint
