// A medium that varies through its body over the spectral image: see sim/model/field.hpp. A pixel looks along several lines where the field is finer than it;
// each line is cut into steps, the farthest first, and each step blended as an even layer: mediumRadiance(). Which elements a pixel may meet is listed by tiles.
//@use sim/radiometry/glsl/medium.glsl
//@constants
//@use sim/render/glsl/volume_ray.glsl
//@use sim/render/glsl/node_block.glsl
layout(binding = 5) uniform samplerBuffer fieldSpectra;  // sim/render/field_tables.hpp says what is where
layout(binding = 17) uniform samplerBuffer fieldTexels;  // of the field's own shader
layout(binding = 19) uniform usamplerBuffer fieldTiles;  // of each tile: first of its list, length; then the lists: texels of elements
uniform vec4 fieldRow0;  // of a Draw: from camera to field axes
uniform vec4 fieldRow1;
uniform vec4 fieldRow2;
uniform float fieldFine;
uniform vec4 fieldRect;      // nothing shows outside: low, high [pixels]
uniform float linesApart;    // [pixels]
uniform ivec4 tileGrid;      // first pixel x, y; tiles across; pixels a side
uniform vec4 planckRange;    // first 1 / T, entries per unit of it

vec4 fieldTexel(int i) { return texelFetch(fieldTexels, i); }
float sunElevation_;
// A line: place at t = 0 in field axes, direction per t, metres per t; where the elements of its tile begin and end on it.
vec3 q_;
vec3 d_;
float perT_;
float enter_;
float leave_;
// Sums over a step: amounts of gases; a weight, and what it weighs: temperature, factor of own radiance, share of the sun, amount towards the sun.
vec4 amountLow_;
vec4 amountHigh_;
float weight_;
float heat_;
float gained_;
float lit_;
float shade_;
//@slot field

//@slot path
AirPath near_, far_;  // from the camera to a step's ends
AirPath sunlit_;      // from the camera to the step and on to the sun
Draw field_;
int list_, listed_, first_;  // the tile's elements; texel of the first that the line meets
int lines_, across_;
vec2 from_, cell_;           // of lines [pixels]
float share_, outside_;
float start_, end_;
int steps_;
float cosScatter_, phaseSun_;
float gain_, sun_, sunAmount_;
int black_;
float blackMix_;
//@each g GASES
int level{g}_;
float levelMix{g}_;
float amount{g}_;
//@end

int linesHere() { return lines_; }

// A line of the pixel: what it meets.
void prepareLine(int l) {
  // Columns and rows each shifted by the golden ratio: what is thinner than their distance and lies along them is met by its share of lines, not by all or none.
  vec2 place = vec2(float(l % across_), float(l / across_));
  prepareRay(from_ + cell_ * (place + fract(vec2(0.5) + 0.6180339887 * place.yx)));
  d_ = inBody(field_, ray_);
  q_ = pointOnPlane(field_);
  perT_ = rayLength_;
  enter_ = kFar;
  leave_ = -kFar;
  first_ = -1;
  for (int e = 0; e < listed_; ++e) {
    int at = int(texelFetch(fieldTiles, list_ + e).x);
    vec2 chord = fieldChord(at);
    if (!(chord.y > chord.x)) continue;
    if (first_ < 0) first_ = at;
    enter_ = min(enter_, chord.x);
    leave_ = max(leave_, chord.y);
  }
  enter_ = max(enter_, start_);
  leave_ = min(leave_, endOfRay(field_));
  steps_ = leave_ > enter_ && first_ >= 0 ? FIELD_STEPS : 0;
  cosScatter_ = dot(ray_, view.sun.xyz) / rayLength_;
}

int layersHere() { return steps_; }

void prepareLayer(int k) {
  float count = float(steps_), from = fieldCut(first_, (count - 1.0 - float(k)) / count), to = fieldCut(first_, (count - float(k)) / count);
  amountLow_ = vec4(0.0);
  amountHigh_ = vec4(0.0);
  weight_ = heat_ = gained_ = lit_ = shade_ = 0.0;
  for (int e = 0; e < listed_; ++e) fieldAdd(int(texelFetch(fieldTiles, list_ + e).x), from, to);
  float inverse = weight_ > 0.0 ? 1.0 / weight_ : 0.0, temperature = weight_ > 0.0 ? heat_ * inverse : 300.0;
  gain_ = gained_ * inverse;
  sun_ = lit_ * inverse;
  sunAmount_ = shade_ * inverse;
//@each g GASES
  amount{g}_ = {g} < 4 ? amountLow_[{g} % 4] : amountHigh_[{g} % 4];
  {
    vec4 gas = texelFetch(fieldSpectra, {g});  // first texel of its levels, number of levels, first texel of what else it has
    int low = 0, last = int(gas.y) - 2;
    for (int i = 1; i <= last; i += 4) {
      vec4 at4 = vec4(texelFetch(fieldSpectra, GASES + LEVELS * {g} + i).x, texelFetch(fieldSpectra, GASES + LEVELS * {g} + min(i + 1, last)).x,
                      texelFetch(fieldSpectra, GASES + LEVELS * {g} + min(i + 2, last)).x, texelFetch(fieldSpectra, GASES + LEVELS * {g} + min(i + 3, last)).x);
      low += int(temperature >= at4.x) + int(i < last && temperature >= at4.y) + int(i + 1 < last && temperature >= at4.z) + int(i + 2 < last && temperature >= at4.w);
    }
    float at = texelFetch(fieldSpectra, GASES + LEVELS * {g} + low).x, next = texelFetch(fieldSpectra, GASES + LEVELS * {g} + low + 1).x;
    levelMix{g}_ = last < 0 ? 0.0 : clamp((temperature - at) / (next - at), 0.0, 1.0);
    level{g}_ = int(gas.x) + low * FOURS;
  }
//@end
  float place = clamp((1.0 / temperature - planckRange.x) * planckRange.y, 0.0, float(BLACK_ENTRIES - 1));
  int entry = min(int(place), BLACK_ENTRIES - 2);
  black_ = BLACK_AT + entry * FOURS;
  blackMix_ = place - float(entry);
  float range = max((planeOf(field_) + from) * rayLength_, 0.0);
  vec3 upThere;
  float height = heightAt(range, upThere);
  sunElevation_ = dot(view.sun.xyz, upThere);
  near_ = airFromCamera(range);
  far_ = airBeyond(near_, range, height, dot(upThere, ray_) / rayLength_, (to - from) * rayLength_);
  sunlit_ = SCATTERS > 0 ? airToSun(near_, height) : near_;
}

vec4 blendedFour(vec4 behind, int four) {
  vec4 black = mix(texelFetch(fieldSpectra, black_ + four), texelFetch(fieldSpectra, black_ + FOURS + four), blackMix_);
  vec4 depth = vec4(0.0), emitted = vec4(0.0), turned = vec4(0.0), result;
//@each g GASES
  {
    vec4 each = mix(texelFetch(fieldSpectra, level{g}_ + four), texelFetch(fieldSpectra, level{g}_ + FOURS + four), levelMix{g}_), own = each * amount{g}_;
    depth += own;
    if (SCATTERS > 0) {
      int other = int(texelFetch(fieldSpectra, {g}).z) + 5 * four;
      vec4 thermal = texelFetch(fieldSpectra, other), radiance = texelFetch(fieldSpectra, other + 1), around = texelFetch(fieldSpectra, other + 2);
      vec4 sunlight = texelFetch(fieldSpectra, other + 3), g1 = texelFetch(fieldSpectra, other + 4);
      vec4 bend = max(1.0 + g1 * g1 - 2.0 * g1 * cosScatter_, vec4(1.0e-6));
      vec4 phase = (1.0 - g1 * g1) / (4.0 * 3.14159265358979 * bend * sqrt(bend));  // Henyey and Greenstein 1941
      emitted += own * (thermal * black + gain_ * radiance + around);
      turned += own * sun_ * sunlight * phase * exp(-min(sunAmount_ * each, vec4(80.0)));
    } else {
      emitted += own * black;
    }
  }
//@end
  vec4 inverse = 1.0 / max(depth, vec4(1.0e-30));
//@each j 4
  {
    int i = min(4 * four + {j}, NODES - 1);
    Real air = pathDepth(i, near_, far_);
    Real before = pathRadiance(i, near_), tau = pathTransmittance(i, near_), inside = pathInside(i, near_, far_);
    Real own = mediumRadiance(depth[{j}], air, before, inside, tau, emitted[{j}] * inverse[{j}]);
    if (SCATTERS > 0) own += pathTransmittance(i, sunlit_) * turned[{j}] * meanDecay(depth[{j}] + air);
    result[{j}] = depth[{j}] > 0.0 ? decay(depth[{j}]) * (behind[{j}] - (before + inside)) + own : behind[{j}];
  }
//@end
  return result;
}

//@slot targets
//@slot blend

void main() {
  vec2 corner = gl_FragCoord.xy - 0.5, low = max(fieldRect.xy, corner), high = min(fieldRect.zw, corner + 1.0);
  if (!(high.x > low.x && high.y > low.y)) discard;
  ivec2 tile = (ivec2(gl_FragCoord.xy) - tileGrid.xy) / tileGrid.w;
  int row = 2 * (tile.y * tileGrid.z + tile.x);
  list_ = int(texelFetch(fieldTiles, row).x);
  listed_ = int(texelFetch(fieldTiles, row + 1).x);
  if (listed_ == 0) discard;
  field_ = Draw(fieldRow0, fieldRow1, fieldRow2, uvec4(0u), vec4(0.0), vec4(fieldFine, 0.0, 0.0, 0.0));
  start_ = -planeOf(field_);  // the camera
  bool fine = linesApart < 1.0;
  vec2 size = fine ? high - low : vec2(1.0);
  // llvmpipe ends all loops of a pixel after 65535 rounds in all (LP_MAX_TGSI_LOOP_ITERATIONS), without a word: fewer lines before that.
  float rounds = float(listed_ + FIELD_STEPS * (1 + listed_ + GASES * (LEVELS / 4 + 1)) + 1);
  int most = clamp(int(sqrt(60000.0 / rounds)), 1, MOST_LINES);
  ivec2 count = fine ? clamp(ivec2(ceil(size / linesApart)), ivec2(1), ivec2(most)) : ivec2(1);
  from_ = fine ? low : corner;
  cell_ = size / vec2(count);
  across_ = count.x;
  lines_ = count.x * count.y;
  share_ = cell_.x * cell_.y;
  outside_ = max(1.0 - size.x * size.y, 0.0);
  blend();
}
