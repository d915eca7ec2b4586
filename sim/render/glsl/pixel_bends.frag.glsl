// 1 where a pixel shaded once is not enough: its subpixels see different parts, or its radiance bends, in some channel, by more than a share of the
// brightest around: across an edge of light or shade by as much as there is between its sides, in what is smooth hardly at all.
layout(location = 0) out float bends;
layout(binding = 0) uniform usampler2D visibility;  // of pixels
layout(binding = 18) uniform usampler2D subpixels;
//@each g GROUPS
layout(binding = 22 + {g}) uniform sampler2D pixels{g};
//@end
uniform int grouped;
uniform float threshold;

ivec2 last_;

bool bendsIn(sampler2D pixels, ivec2 p) {
  vec4 here = texelFetch(pixels, p, 0), most = here, bend = vec4(0.0);
  for (int k = 0; k < 4; ++k) {
    ivec2 step = ivec2(k == 0 ? 0 : 1, k == 0 ? 1 : k - 2);
    vec4 a = texelFetch(pixels, clamp(p - step, ivec2(0), last_), 0), b = texelFetch(pixels, clamp(p + step, ivec2(0), last_), 0);
    most = max(most, max(a, b));
    bend = max(bend, abs(a + b - 2.0 * here));
  }
  return !all(lessThanEqual(bend, threshold * most));
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  last_ = textureSize(visibility, 0) - 1;
  uint draw = texelFetch(visibility, p, 0).x;
  bool enough = true;
  for (int y = 0; y < grouped; ++y)
    for (int x = 0; x < grouped; ++x) enough = enough && texelFetch(subpixels, grouped * p + ivec2(x, y), 0).x == draw;
//@each g GROUPS
  enough = enough && !bendsIn(pixels{g}, p);
//@end
  bends = enough ? 0.0 : 1.0;
}
