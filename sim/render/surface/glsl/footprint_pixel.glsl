// Textures over what a pixel covers of them. See sim/scene/texture.cpp, which does the same in double precision.
//@use sim/radiometry/glsl/footprint.glsl
layout(binding = 30) uniform samplerBuffer levels;  // mean, second and third central moment of what a texel of a level covers; its own value

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
vec3 momentsAbout(float from, vec4 texel) {
  float d = texel.x - from;
  return vec3(d, texel.y + d * d, texel.z + d * (3.0 * texel.y + d * d));
}

// Two temperatures and the share of the second: twoTemperatures(). Of temperatures the texture itself is among the levels.
vec3 temperaturesOf(int texture) {
  Places p = placesOf(texture);
  int first = int(texelFetch(textureShapes, texture).w >> 6);
  float spread = 1.0;
  if (p.fine) {
    p.shape = ivec4(texelFetch(textureShapes, first - 1));
    vec2 width = vec2(length(p.along) * float(p.alongCount), length(p.across) * float(p.count / max(p.alongCount, 1)));
    vec2 share = clamp(2.0 * width - 1.0, 0.0, 1.0);
    spread = share.x * share.y;
  }
  vec3 sum = vec3(0.0);
  // About the value of a place itself: of a texel beside it the powers would swallow what is left of the pixel's own spread.
  Corners begin = placeAt(p, 0);
  float from = bilinear(vec4(texelFetch(levels, begin.texel.x).w, texelFetch(levels, begin.texel.y).w, texelFetch(levels, begin.texel.z).w,
                             texelFetch(levels, begin.texel.w).w), begin.f);
  for (int n = 0; n < p.count; ++n) {
    Corners c = placeAt(p, n);
    vec4 t00 = texelFetch(levels, c.texel.x), t10 = texelFetch(levels, c.texel.y), t01 = texelFetch(levels, c.texel.z), t11 = texelFetch(levels, c.texel.w);
    float d = bilinear(vec4(t00.w, t10.w, t01.w, t11.w) - from, c.f);
    vec3 all = mix(mix(momentsAbout(from, t00), momentsAbout(from, t10), c.f.x), mix(momentsAbout(from, t01), momentsAbout(from, t11), c.f.x), c.f.y);
    sum += mix(vec3(d, d * d, d * d * d), all, spread);
  }
  sum /= float(max(p.count, 1));
  return twoTemperatures(from + sum.x, sum.y - sum.x * sum.x, sum.z - 3.0 * sum.x * sum.y + 2.0 * sum.x * sum.x * sum.x);
}
