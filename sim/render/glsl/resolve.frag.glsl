// Pixels from their subpixels, or from what was shaded for all of them at once.
layout(binding = 19) uniform sampler2D bends;
uniform bool isShared;
uniform int across;  // subpixels a side
uniform vec4 film;   // tangents per subpixel, axis

// cos^4 of the angle off the axis: a subpixel's projected solid angle over that on the axis; what it changes within one is nearly the same for all.
float weightOf(ivec2 subpixel) {
  vec2 t = (vec2(subpixel) + 0.5 - film.zw) * film.xy;
  float l2 = 1.0 + dot(t, t);
  return 1.0 / (l2 * l2);
}
vec4 meanOf(sampler2D subpixels, ivec2 p) {
  vec4 sum = vec4(0.0);
  float all = 0.0;
  for (int y = 0; y < across; ++y)
    for (int x = 0; x < across; ++x) {
      ivec2 at = across * p + ivec2(x, y);
      float w = weightOf(at);
      sum += w * texelFetch(subpixels, at, 0);
      all += w;
    }
  return sum / all;
}
vec4 middleOf(sampler2D subpixels, ivec2 p) { return texelFetch(subpixels, across * p + across / 2, 0); }
//@slot resolve
