//@constants
// 0 where a pixel shaded once is enough; else 1 + what its subpixels need (class_depth.glsl). It is not enough where its subpixels see different parts, or its
// radiance bends, in some channel, by more than a share of the brightest around (or, where textures are read over whole pixels, its light does): across an edge
// of light or shade by as much as there is between its sides, in what is smooth hardly at all. Subpixels need all lights where they see different parts, else
// what their pixel or any around it needs: an edge of a shadow or of a lamp's reach lies between the middles of pixels.
layout(location = 0) out float bends;
layout(binding = 0) uniform usampler2D visibility;  // of pixels
layout(binding = 18) uniform usampler2D subpixels;
//@each g GROUPS
layout(binding = 22 + {g}) uniform sampler2D pixels{g};
//@end
//@each g GROUPS
layout(binding = 26 + {g}) uniform sampler2D before{g};
//@end
layout(binding = 17) uniform sampler2D smoothness;  // see classes.frag.glsl
const int kEveryLight = 2;
uniform ivec2 last;  // pixel of the picture
uniform float threshold;
uniform bool drawnOver;  // something transparent is, what was there before in these

bool bendsBy(vec4 bend, vec4 most) { return !all(lessThanEqual(bend, threshold * most)); }

bool bendsIn(sampler2D pixels, ivec2 p) {
  vec4 here = texelFetch(pixels, p, 0), most = here, bend = vec4(0.0);
  for (int k = 0; k < 4; ++k) {
    ivec2 step = ivec2(k == 0 ? 0 : 1, k == 0 ? 1 : k - 2);
    vec4 a = texelFetch(pixels, clamp(p - step, ivec2(0), last), 0), b = texelFetch(pixels, clamp(p + step, ivec2(0), last), 0);
    most = max(most, max(a, b));
    bend = max(bend, abs(a + b - 2.0 * here));
  }
  return bendsBy(bend, most);
}

// What transparent things have added or taken away, against what is left.
bool changeBendsIn(sampler2D pixels, sampler2D before, ivec2 p) {
  vec4 here = texelFetch(pixels, p, 0), most = here, change = here - texelFetch(before, p, 0), bend = vec4(0.0);
  for (int k = 0; k < 4; ++k) {
    ivec2 step = ivec2(k == 0 ? 0 : 1, k == 0 ? 1 : k - 2), back = clamp(p - step, ivec2(0), last), on = clamp(p + step, ivec2(0), last);
    vec4 a = texelFetch(pixels, back, 0), b = texelFetch(pixels, on, 0);
    most = max(most, max(a, b));
    bend = max(bend, abs(a - texelFetch(before, back, 0) + b - texelFetch(before, on, 0) - 2.0 * change));
  }
  return bendsBy(bend, most);
}

// A ridge before what lies behind it is a step in 1 / depth; a smaller one, within one part, is taken for the slope of the ground.
const float kRidge = 0.03;

bool lightBends_;
float needed_;

void lookAround(ivec2 p) {
  vec3 here = texelFetch(smoothness, p, 0).xyz;
  lightBends_ = here.x < 0.0;
  needed_ = here.z;
  for (int k = 0; k < 4; ++k) {
    ivec2 step = ivec2(k == 0 ? 0 : 1, k == 0 ? 1 : k - 2);
    vec3 a = texelFetch(smoothness, clamp(p - step, ivec2(0), last), 0).xyz, b = texelFetch(smoothness, clamp(p + step, ivec2(0), last), 0).xyz;
    vec2 most = max(here.xy, max(a.xy, b.xy)), bend = abs(a.xy + b.xy - 2.0 * here.xy);
    lightBends_ = lightBends_ || min(a.x, b.x) < 0.0 || bend.x > threshold * most.x || bend.y > kRidge * most.y;
    needed_ = max(needed_, max(a.z, b.z));
  }
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  uint draw = texelFetch(visibility, p, 0).x;
  bool same = true;
  for (int y = 0; y < GROUPED; ++y)
    for (int x = 0; x < GROUPED; ++x) same = same && texelFetch(subpixels, GROUPED * p + ivec2(x, y), 0).x == draw;
  bool smoothly = true;
//@each g GROUPS
  smoothly = smoothly && !bendsIn(pixels{g}, p);
//@end
  bool evenly = true;
  if (DRAWN_OVER == 1 && drawnOver) {
//@each g GROUPS
    evenly = evenly && !changeBendsIn(pixels{g}, before{g}, p);
//@end
  }
  lookAround(p);
  bool enough = same && (smoothly || (FILTERED == 1 && evenly && !lightBends_));
  bends = enough ? 0.0 : 1.0 + (same ? needed_ : float(kEveryLight));
}
