// What of a light a point sees: 0 where an opaque body stands between, else 1. Depth maps decide where they can, rays where they cannot; see
// sim/render/shadow/shadow_pass.hpp. All in the caster's body axes.
//@use sim/render/shadow/glsl/shadow_list.glsl
struct Shadow {
  vec4 map[4];   // rows: map from receiver; (texels, texels, depth, 1) x w
  vec4 body[3];  // rows: caster from receiver [m]
  ivec4 what;    // map or -1; first and end of the caster's tree; 0 another body, or 1 + how it shades itself; 8 more: its clear facets are known
  vec4 fine;     // rounding of the map's depth; a texel's size in depth; distance by which a ray leaves its own body; depth 0 to 1 where even, or 0 [m]
  vec4 ball;     // around the caster, in the receiver's body axes [m]
};
layout(binding = 14) uniform usamplerBuffer trees;
Shadow shadowAt(int number) {
  return Shadow(vec4[4](shadowRow(number, 0), shadowRow(number, 1), shadowRow(number, 2), shadowRow(number, 3)),
                vec4[3](shadowRow(number, 4), shadowRow(number, 5), shadowRow(number, 6)), ivec4(shadowTexel(number, 7)), shadowRow(number, 8),
                shadowRow(number, 9));
}
vec3 treeFloats(int at) { return uintBitsToFloat(texelFetch(trees, at).xyz); }
layout(binding = 16) uniform sampler2DArray shadowMaps;
const int kNever = 1, kInside = 2, kOneSided = 3, kOpen = 4;  // 1 + SelfShadow

// Whether a ray meets a triangle of a tree nearer than `farthest`. side: 0 both sides of triangles count; 1 those met from outside, -1 from inside.
bool meetsTree(int at, int end, vec3 origin, vec3 direction, float farthest, float side) {
  // An exact 0 would make 0 x infinity of a ray in a box's side.
  vec3 safe = mix(direction, vec3(1.0e-30), lessThan(abs(direction), vec3(1.0e-30)));
  vec3 inverse = 1.0 / safe;
  bool met = false;
  while (at < end) {
    // Boxes until one with triangles: llvmpipe runs the body of a loop once where it has nothing to do, so boxes don't pay for triangles.
    int count = 0;
    while (at < end && count == 0) {
      uvec4 low = texelFetch(trees, at), high = texelFetch(trees, at + 1);
      vec3 a = (uintBitsToFloat(low.xyz) - origin) * inverse, b = (uintBitsToFloat(high.xyz) - origin) * inverse;
      vec3 enter = min(a, b), leave = max(a, b);
      float from = max(max(enter.x, enter.y), max(enter.z, 0.0)), to = min(min(leave.x, leave.y), min(leave.z, farthest));
      bool missed = from > to + 1.0e-6 * max(from, abs(to));  // with room for the rounding of differences and products
      at = missed ? int(low.w) : at + 2;
      count = missed ? 0 : int(high.w);
    }
    for (int last = at + 3 * count; at < last; at += 3) {
      vec3 corner = treeFloats(at);
      vec3 e1 = treeFloats(at + 1) - corner, e2 = treeFloats(at + 2) - corner;
      vec3 p = cross(direction, e2), q = origin - corner, r = cross(q, e1);
      float det = dot(e1, p);
      float inverseDet = det != 0.0 ? 1.0 / det : 0.0;
      float v = dot(q, p) * inverseDet, w = dot(direction, r) * inverseDet, t = dot(e2, r) * inverseDet;
      // Neighbours overlap by the rounding of v and w: no light leaks through between them.
      met = met || (det != 0.0 && side * det >= 0.0 && min(v, w) >= -1.0e-6 && v + w <= 1.000001 && t > 0.0 && t < farthest);
    }
    if (met) at = end;
  }
  return met;
}

float stopsWithin_;  // where a map has not decided: no farther off is what it has seen before the point [m]

float inMap(vec4 row) { return dot(row.xyz, point_) + row.w; }

// 1 clear, -1 stopped, 0 undecided.
int mapSays(Shadow s, vec3 facet) {
  stopsWithin_ = kFar;
  float w = inMap(s.map[3]);
  if (w <= 0.0) return 1;  // behind the light
  vec3 at = vec3(inMap(s.map[0]), inMap(s.map[1]), inMap(s.map[2])) / w;
  float size = float(textureSize(shadowMaps, 0).x), noise = s.fine.x / w + 2.0e-7;
  if (at.z < -noise || any(lessThan(at.xy, vec2(0.5))) || any(greaterThan(at.xy, vec2(size - 0.5)))) return 1;
  // How depth changes over the map on the plane through the point: two tangents, projected, then solved for.
  vec3 t1 = normalize(cross(facet, abs(facet.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0))), t2 = cross(facet, t1);
  float w1 = dot(s.map[3].xyz, t1), w2 = dot(s.map[3].xyz, t2);
  vec3 j1 = vec3(dot(s.map[0].xyz, t1), dot(s.map[1].xyz, t1), dot(s.map[2].xyz, t1)) - at * w1;
  vec3 j2 = vec3(dot(s.map[0].xyz, t2), dot(s.map[1].xyz, t2), dot(s.map[2].xyz, t2)) - at * w2;
  float det = j1.x * j2.y - j1.y * j2.x;
  if (abs(det) <= 1.0e-6 * length(j1.xy) * length(j2.xy)) return 0;  // edge on
  vec2 slope = vec2(j1.z * j2.y - j2.z * j1.y, j1.x * j2.z - j2.x * j1.z) / det;
  float steep = abs(slope.x) + abs(slope.y);
  ivec2 cell = ivec2(floor(at.xy - 0.5));
  float nearest = kFar, farthest = -kFar;
  for (int k = 0; k < 4; ++k) {
    ivec2 texel = cell + ivec2(k & 1, k >> 1);
    float surface = texelFetch(shadowMaps, ivec3(texel, s.what.x), 0).x;
    float before = surface >= 1.0 ? kFar : surface - (at.z + dot(slope, vec2(texel) + 0.5 - at.xy));  // 1 is left by the clearing: nothing there
    nearest = min(nearest, before);
    farthest = max(farthest, before);
  }
  // The rasteriser moves corners by up to 1/256 of a texel: a map's depth is as uncertain as the slope over that makes it.
  if (nearest >= -(noise + steep / 128.0)) return 1;
  // What is seen before the plane may rise by as much again to where the point's own line meets it.
  if (s.fine.w > 0.0) stopsWithin_ = 2.0 * (noise + steep + s.fine.y - nearest) * s.fine.w;
  // Stopped for sure only by something that is no part of the surface around the point: farther off than it can rise in two texels.
  return farthest < -(noise + 2.0 * (steep + s.fine.y)) ? -1 : 0;
}

bool stops(int number, vec3 toLight, float farthest) {
  Shadow s = shadowAt(number);
  vec3 facet = normalize(facet_);
  float outside = dot(facet, toViewer_) >= 0.0 ? 1.0 : -1.0, lightSide = dot(facet, toLight) >= 0.0 ? 1.0 : -1.0;
  int kind = s.what.w & 7;
  if (kind == kInside && outside > 0.0) return false;
  bool away = outside != lightSide;  // the light is behind the facet, though not behind the surface that it stands for
  bool oneSided = kind == kInside || kind == kOneSided || (kind == kOpen && away);
  if (s.what.x >= 0 && !away) {
    int says = mapSays(s, facet);
    if (says != 0) return says < 0;
    farthest = min(farthest, stopsWithin_);
  }
  vec3 from = point_ + (lightSide * s.fine.z) * facet;
  vec3 origin = vec3(dot(s.body[0].xyz, from) + s.body[0].w, dot(s.body[1].xyz, from) + s.body[1].w, dot(s.body[2].xyz, from) + s.body[2].w);
  vec3 direction = vec3(dot(s.body[0].xyz, toLight), dot(s.body[1].xyz, toLight), dot(s.body[2].xyz, toLight));
  return meetsTree(s.what.y, s.what.z, origin, direction, farthest, oneSided ? outside : 0.0);
}

// listed: of a body's row of lights, (light, first caster, casters). Nothing beyond `farthest` counts [m].
float shareSeen(vec4 listed, vec3 toLight, float farthest) {
  int first = int(listed.y), last = first + int(listed.z);
  float seen = 1.0;
  prepareClear(toLight);
  // llvmpipe runs a loop's body once where no pixel has anything to do in it: those that cannot stop the light are passed over by themselves.
  for (int k = first; k < last && seen > 0.0; ++k) {
    while (k < last && !mayStop(k, toLight)) ++k;
    if (k < last && stops(k, toLight, farthest)) seen = 0.0;
  }
  return seen;
}
