// Textures over what a pixel covers of them. See sim/scene/texture.cpp, which does the same in double precision.
//@use sim/radiometry/glsl/footprint.glsl
layout(binding = 30) uniform samplerBuffer levels;  // mean, second and third central moment of what a texel of a level covers

// The places of a pixel in a texture.
struct Places {
  vec2 first, along, across;  // [texels of the texture]
  vec2 scale;                 // to those of the level
  int alongCount, count;
  ivec4 shape;                // of the level
  bool repeats, fine;         // fine: it is the texture itself
};
Places placesOf(int texture) {
  ivec4 shape = ivec4(texelFetch(textureShapes, texture));
  vec2 size = vec2(shape.yz);
  Taps taps = tapsOf(uvAcross_ * size, uvUp_ * size, 0.1 * float(TAPS_PER_TEN_TEXELS), float(TAPS_ACROSS), float(TAPS_ALONG), (shape.w >> 1) & 31);
  Places p;
  p.fine = taps.level == 0;
  p.shape = ivec4(texelFetch(textureShapes, p.fine ? texture : (shape.w >> 6) + taps.level - 1));
  p.repeats = (shape.w & 1) == 1;
  p.scale = vec2(p.shape.yz) / size;
  p.along = taps.along;
  p.across = taps.across;
  p.first = uv_ * size - 0.5 * (float(taps.alongCount - 1) * taps.along + float(taps.acrossCount - 1) * taps.across);
  p.alongCount = taps.alongCount;
  p.count = texture < 0 ? 0 : taps.alongCount * taps.acrossCount;
  return p;
}
Corners placeAt(Places p, int n) {
  float row = floor((float(n) + 0.5) / float(p.alongCount));
  return cornersOf(p.shape, p.repeats, (p.first + (float(n) - row * float(p.alongCount)) * p.along + row * p.across) * p.scale);
}

// A loop without turns is skipped where no pixel nearby has any; drivers without a GPU take both sides of a condition.
float textureValue(int texture) {
  Places p = placesOf(texture);
  float sum = 0.0;
  for (int n = 0; n < (p.fine ? p.count : 0); ++n) {
    Corners c = placeAt(p, n);
    sum += bilinear(texelsAt(c.texel), c.f);
  }
  for (int n = 0; n < (p.fine ? 0 : p.count); ++n) {
    Corners c = placeAt(p, n);
    ivec4 t = c.texel;
    sum += bilinear(vec4(texelFetch(levels, t.x).x, texelFetch(levels, t.y).x, texelFetch(levels, t.z).x, texelFetch(levels, t.w).x), c.f);
  }
  return sum / float(max(p.count, 1));
}

// Moments about `from` of what a texel covers, from those about its mean.
vec3 momentsAbout(float from, int texel) {
  vec3 m = texelFetch(levels, texel).xyz;
  float d = m.x - from;
  return vec3(d, m.y + d * d, m.z + d * (3.0 * m.y + d * d));
}

// Two temperatures and the share of the second: twoTemperatures().
vec3 temperaturesOf(int texture) {
  Places p = placesOf(texture);
  vec3 sum = vec3(0.0);
  float from = p.fine ? texelAt(placeAt(p, 0).texel.x) : texelFetch(levels, placeAt(p, 0).texel.x).x;
  for (int n = 0; n < (p.fine ? p.count : 0); ++n) {
    Corners c = placeAt(p, n);
    float d = bilinear(texelsAt(c.texel) - from, c.f);
    sum += vec3(d, d * d, d * d * d);
  }
  for (int n = 0; n < (p.fine ? 0 : p.count); ++n) {
    Corners c = placeAt(p, n);
    sum += mix(mix(momentsAbout(from, c.texel.x), momentsAbout(from, c.texel.y), c.f.x), mix(momentsAbout(from, c.texel.z), momentsAbout(from, c.texel.w), c.f.x), c.f.y);
  }
  sum /= float(max(p.count, 1));
  return twoTemperatures(from + sum.x, sum.y - sum.x * sum.x, sum.z - 3.0 * sum.x * sum.y + 2.0 * sum.x * sum.x * sum.x);
}
