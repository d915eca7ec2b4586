// A medium that varies through its body over the spectral image: see sim/model/field.hpp. A pixel looks along several lines where the field is finer than it;
// each line is cut into steps, the farthest first, each blended as an even layer (sim/radiometry/glsl/medium.glsl). Which elements a pixel may meet is listed
// by tiles. Air is worked out for a stretch of many steps where it is nearly even on it.
//@use sim/radiometry/glsl/medium.glsl
//@constants
//@use sim/render/glsl/volume_ray.glsl
//@use sim/render/glsl/node_block.glsl
layout(binding = 5) uniform samplerBuffer fieldSpectra;  // sim/render/field_tables.hpp says what is where
layout(binding = 17) uniform samplerBuffer fieldTexels;  // of the field's own shader
// Of each tile: first of its list, length, lines across a pixel, lines a pixel (floats), steps; then the lists: texels of elements.
layout(binding = 19) uniform usamplerBuffer fieldTiles;
uniform vec4 fieldRow0;  // of a Draw: from camera to field axes
uniform vec4 fieldRow1;
uniform vec4 fieldRow2;
uniform float fieldFine;
uniform vec4 fieldRect;    // nothing shows outside: low, high [pixels]
uniform vec2 fieldRange;   // from the camera to its nearest and farthest [m], where it is so far that the air across it is nearly even; else 0, 0
uniform float linesAlone;  // up to so many lines across a pixel its middle alone is as good
uniform ivec4 tileGrid;    // first pixel x, y; tiles across; pixels a side
uniform vec4 planckRange;  // first 1 / T, entries per unit of it, texel of the first
uniform vec4 gasLevels[MIXTURES * LEVEL_FOURS];  // temperatures of levels [K], ended by some far above any

/// Air is nearly even on a stretch shorter than this part of the way to it: what its optical depth d there makes of exp(-d) is told by three terms to 2e-4.
const float kEven = 0.1;

vec4 fieldTexel(int i) { return texelFetch(fieldTexels, i); }
float sunElevation_;
// A line: place at t = 0 in field axes, direction per t, metres per t; where the elements of its tile begin and end on it.
vec3 q_;
vec3 d_;
float perT_;
float enter_;
float leave_;
// Sums over a step: amounts of mixtures; a weight, and what it weighs: temperature, factor of own radiance, share of the sun, amount towards the sun.
vec4 amountLow_;
vec4 amountHigh_;
float weight_;
float heat_;
float gained_;
float lit_;
float shade_;
//@slot field

//@slot targets
//@slot path
Draw field_;
int list_, listed_, first_, cuts_;  // the tile's elements, and steps of its lines; texel of the first that the line meets
uvec2 met_;                  // of the first 64 of the list, those that the line meets
int lines_, turn_;           // of the pixel; steps of the lattice that they lie on
vec2 from_, size_;           // of what they cover [pixels]
float start_;
int steps_, together_;       // steps of a line; of a stretch of air
float cosScatter_;
float gain_, sun_, sunAmount_;
int black_;
float blackMix_;
//@each g MIXTURES
int level{g}_;
float levelMix{g}_;
float amount{g}_;
//@end

// Air of a stretch, four nodes each: transmittance to its near end, optical depth and radiance on it, path radiance to its near end, transmittance on to the
// sun.
vec2 stretch_;      // [m] from the camera
float low_, high_;  // of a step, parts of the stretch
//@each t TARGETS
vec4 tau{t}_, depth{t}_, inside{t}_, before{t}_, sunlit{t}_;
//@end

float partOf(float t) { return clamp(((planeOf(field_) + t) * rayLength_ - stretch_.x) / max(stretch_.y - stretch_.x, 1.0e-6), 0.0, 1.0); }

void setAir(float nearest, float farthest) {
  stretch_ = vec2(max(nearest, 0.0), max(farthest, 0.0));
  vec3 upThere;
  float height = heightAt(stretch_.x, upThere);
  sunElevation_ = dot(view.sun.xyz, upThere);
  AirPath near = airFromCamera(stretch_.x), far = airBeyond(near, stretch_.x, height, dot(upThere, ray_) / rayLength_, stretch_.y - stretch_.x), toSun = near;
  if (SCATTERS > 0) toSun = airToSun(near, height);
//@each t TARGETS
//@each j 4
  {
    int i = min(4 * fourOf({t}) + {j}, NODES - 1);
    tau{t}_[{j}] = pathTransmittance(i, near);
    depth{t}_[{j}] = pathDepth(i, near, far);
    inside{t}_[{j}] = pathInside(i, near, far);
    before{t}_[{j}] = pathRadiance(i, near);
    if (SCATTERS > 0) sunlit{t}_[{j}] = pathTransmittance(i, toSun);
  }
//@end
//@end
}

// The part of a stretch's radiance that comes from before a place on it, (1 - exp(-depth u))/(1 - exp(-depth)): exact at its ends, else to the square of the
// depth.
vec4 partBefore(float u, vec4 depth) { return u * (1.0 + 0.5 * (1.0 - u) * depth); }

// meanDecay(), of exp(-x) that is known.
vec4 meanOf(vec4 x, vec4 decayed) {
  vec4 series = 1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0 * (1.0 - x / 6.0))));
  return mix((1.0 - decayed) / max(x, vec4(0.1)), series, lessThan(x, vec4(0.125)));
}

// A line of the pixel: what it meets.
void prepareLine(int l) {
  prepareRay(from_ + size_ * vec2((float(l) + 0.5) / float(lines_), fract((float((l * turn_) % lines_) + 0.5) / float(lines_))));
  d_ = inBody(field_, ray_);
  q_ = pointOnPlane(field_);
  perT_ = rayLength_;
  enter_ = kFar;
  leave_ = -kFar;
  first_ = -1;
  met_ = uvec2(0u);
  for (int e = 0; e < listed_; ++e) {
    int at = int(texelFetch(fieldTiles, list_ + e).x);
    vec2 chord = fieldChord(at);
    if (!(chord.y > chord.x)) continue;
    if (first_ < 0) first_ = at;
    enter_ = min(enter_, chord.x);
    leave_ = max(leave_, chord.y);
    if (e < 32) met_.x |= 1u << uint(e);
    else if (e < 64) met_.y |= 1u << uint(e - 32);
  }
  enter_ = max(enter_, start_);
  leave_ = min(leave_, endOfRay(field_));
  steps_ = leave_ > enter_ && first_ >= 0 ? cuts_ : 0;
  if (steps_ > 0) fieldLine(first_, steps_);
  cosScatter_ = dot(ray_, view.sun.xyz) / rayLength_;
  together_ = fieldRange.y > 0.0 || (leave_ - enter_) * rayLength_ < kEven * (planeOf(field_) + enter_) * rayLength_ ? max(steps_, 1) : 1;
}

void addMet(int from, uint met, float enter, float leave) {
  while (met != 0u) {
    int e = findLSB(met);
    met &= met - 1u;
    fieldAdd(int(texelFetch(fieldTiles, list_ + from + e).x), enter, leave);
  }
}

void prepareStep(float from, float to) {
  amountLow_ = vec4(0.0);
  amountHigh_ = vec4(0.0);
  weight_ = heat_ = gained_ = lit_ = shade_ = 0.0;
  addMet(0, met_.x, from, to);
  addMet(32, met_.y, from, to);
  for (int e = 64; e < listed_; ++e) fieldAdd(int(texelFetch(fieldTiles, list_ + e).x), from, to);
  float inverse = weight_ > 0.0 ? 1.0 / weight_ : 0.0, temperature = weight_ > 0.0 ? heat_ * inverse : 300.0;
  gain_ = gained_ * inverse;
  sun_ = lit_ * inverse;
  sunAmount_ = shade_ * inverse;
//@each g MIXTURES
  amount{g}_ = {g} < 4 ? amountLow_[{g} % 4] : amountHigh_[{g} % 4];
  {
    vec4 gas = texelFetch(fieldSpectra, {g});  // first texel of its levels, number of levels, first texel of what else it has
    float passed = -1.0;
//@each v LEVEL_FOURS
    passed += dot(vec4(greaterThanEqual(vec4(temperature), gasLevels[{g} * LEVEL_FOURS + {v}])), vec4(1.0));
//@end
    int low = int(clamp(passed, 0.0, max(gas.y - 2.0, 0.0)));
    float at = texelFetch(fieldSpectra, MIXTURES + 4 * LEVEL_FOURS * {g} + low).x, next = texelFetch(fieldSpectra, MIXTURES + 4 * LEVEL_FOURS * {g} + low + 1).x;
    levelMix{g}_ = gas.y < 2.0 ? 0.0 : clamp((temperature - at) / (next - at), 0.0, 1.0);
    level{g}_ = int(gas.x) + low * FOURS;
  }
//@end
  float place = clamp((1.0 / temperature - planckRange.x) * planckRange.y, 0.0, float(BLACK_ENTRIES - 1));
  int entry = min(int(place), BLACK_ENTRIES - 2);
  black_ = int(planckRange.z) + entry * FOURS;
  blackMix_ = place - float(entry);
  low_ = partOf(from);
  high_ = partOf(to);
}

// What a step has of the gases at four nodes: optical depth, emission x depth, sunlight turned to the camera x depth.
struct Matter {
  vec4 depth, emitted, turned;
};

Matter matterAt(int four) {
  vec4 black = mix(texelFetch(fieldSpectra, black_ + four), texelFetch(fieldSpectra, black_ + FOURS + four), blackMix_);
  Matter m = Matter(vec4(0.0), vec4(0.0), vec4(0.0));
//@each g MIXTURES
  {
    vec4 each = mix(texelFetch(fieldSpectra, level{g}_ + four), texelFetch(fieldSpectra, level{g}_ + FOURS + four), levelMix{g}_), own = each * amount{g}_;
    m.depth += own;
    if (SCATTERS > 0) {
      int other = int(texelFetch(fieldSpectra, {g}).z) + 5 * four;
      vec4 thermal = texelFetch(fieldSpectra, other), radiance = texelFetch(fieldSpectra, other + 1), around = texelFetch(fieldSpectra, other + 2);
      vec4 sunlight = texelFetch(fieldSpectra, other + 3), g1 = texelFetch(fieldSpectra, other + 4);
      vec4 bend = max(1.0 + g1 * g1 - 2.0 * g1 * cosScatter_, vec4(1.0e-6));
      vec4 phase = (1.0 - g1 * g1) / (4.0 * 3.14159265358979 * bend * sqrt(bend));  // Henyey and Greenstein 1941
      m.emitted += own * (thermal * black + gain_ * radiance + around);
      m.turned += own * sun_ * sunlight * phase * exp(-min(sunAmount_ * each, vec4(80.0)));
    } else {
      m.emitted += own * black;
    }
  }
//@end
  return m;
}

// A step: what comes from behind, less what air alone would show to its far end, is what the result is to its near end.
//   y' = y exp(-a) + I E(a + g)/E(g) + tau S a E(a + g),   E(x) = (1 - exp(-x))/x: as mediumRadiance() has it, I radiance of the air on the step.
// EVEN: the air's depth g on a step is so small that E(a) does for both, and the step is seen through the air before its middle.
vec4 stepped(vec4 behind, vec4 tau, vec4 airDepth, vec4 inside, vec4 sunlit, int four) {
  Matter m = matterAt(four);
  vec4 passed = exp(-min(m.depth, vec4(80.0)));
  if (EVEN > 0) {
    vec4 upTo = airDepth * (0.5 * (low_ + high_)), fallen = 1.0 - upTo * (1.0 - 0.5 * upTo);
    vec4 light = inside * ((high_ - low_) + (0.5 * ((1.0 - high_) * high_ - (1.0 - low_) * low_)) * airDepth);
    vec4 mean = mix((1.0 - passed) / m.depth, 1.0 - 0.5 * m.depth, lessThan(m.depth, vec4(2.0e-3)));
    return passed * behind + mean * (light + fallen * (tau * m.emitted + sunlit * m.turned));
  }
  vec4 beside = airDepth * (high_ - low_), clear = exp(-min(beside, vec4(80.0)));
  vec4 mean = meanOf(m.depth + beside, passed * clear), upTo = airDepth * low_, fallen = 1.0 - upTo * (1.0 - 0.5 * upTo);
  vec4 light = inside * (partBefore(high_, airDepth) - partBefore(low_, airDepth));
  return passed * behind + light * mean / meanOf(beside, clear) + fallen * mean * (tau * m.emitted + sunlit * m.turned);
}

// Points of a lattice of Fibonacci's, as many as wanted or a few more: their rows and columns are all different, and no two are near each other.
void setLattice(float wanted) {
  int before = 1;
  lines_ = 1;
  for (int k = 0; k < 15; ++k) {
    if (float(lines_) >= wanted) break;
    int next = lines_ + before;
    before = lines_;
    lines_ = next;
  }
  turn_ = before;
}

void main() {
  vec2 corner = gl_FragCoord.xy - 0.5, low = max(fieldRect.xy, corner), high = min(fieldRect.zw, corner + 1.0);
  if (!(high.x > low.x && high.y > low.y)) discard;
  ivec2 tile = (ivec2(gl_FragCoord.xy) - tileGrid.xy) / tileGrid.w;
  int row = 5 * (tile.y * tileGrid.z + tile.x);
  list_ = int(texelFetch(fieldTiles, row).x);
  listed_ = int(texelFetch(fieldTiles, row + 1).x);
  if (listed_ == 0) discard;
  cuts_ = int(texelFetch(fieldTiles, row + 4).x);
  field_ = Draw(fieldRow0, fieldRow1, fieldRow2, uvec4(0u), vec4(0.0), vec4(fieldFine, 0.0, 0.0, 0.0));
  start_ = -planeOf(field_);  // the camera
  float across = uintBitsToFloat(texelFetch(fieldTiles, row + 2).x), perPixel = uintBitsToFloat(texelFetch(fieldTiles, row + 3).x);
  bool fine = across > linesAlone;
  size_ = fine ? high - low : vec2(1.0);
  from_ = fine ? low : corner;
  // llvmpipe ends all loops of a pixel after 65535 rounds in all (LP_MAX_TGSI_LOOP_ITERATIONS), each loop's last among them, without a word: fewer lines before
  // that.
  float most = clamp(60000.0 / float(2 * listed_ + cuts_ * (6 + 2 * listed_) + 16), 1.0, float(MOST_LINES));
  setLattice(fine ? min(max(perPixel * size_.x * size_.y, 1.5 * across * max(size_.x, size_.y)), most) : 1.0);
  if (float(lines_) > most && turn_ < lines_) {
    int fewer = lines_ - turn_;
    lines_ = turn_;
    turn_ = fewer;
  }
  float share = size_.x * size_.y / float(lines_), outside = max(1.0 - size_.x * size_.y, 0.0);
//@each t TARGETS
  vec4 under{t}_ = spectrumBelow{t}(), sum{t} = outside * under{t}_;
//@end
  if (EVEN > 0) setAir(fieldRange.x, fieldRange.y);
  for (int l = 0; l < lines_; ++l) {
    prepareLine(l);
//@each t TARGETS
    vec4 line{t} = under{t}_;
//@end
    float to = leave_;
    if (EVEN > 0) {
      high_ = partOf(leave_);
//@each t TARGETS
      line{t} -= before{t}_ + inside{t}_ * partBefore(high_, depth{t}_);
//@end
    }
    for (int k = 0; k < steps_; ++k) {
      float from = fieldCut((float(steps_) - 1.0 - float(k)) / float(steps_));
      if (EVEN > 0) {
        prepareStep(from, to);
//@each t TARGETS
        line{t} = stepped(line{t}, tau{t}_, depth{t}_, inside{t}_, sunlit{t}_, fourOf({t}));
//@end
      } else {
        bool opens = k % together_ == 0, closes = k % together_ == together_ - 1;
        float toIt = planeOf(field_);
        if (opens) setAir((toIt + (together_ > 1 ? enter_ : from)) * rayLength_, (toIt + to) * rayLength_);
        prepareStep(from, to);
//@each t TARGETS
        {
          vec4 beyond = opens ? before{t}_ + inside{t}_ * partBefore(high_, depth{t}_) : vec4(0.0);
          vec4 y = stepped(line{t} - beyond, tau{t}_, depth{t}_, inside{t}_, sunlit{t}_, fourOf({t}));
          line{t} = closes ? y + before{t}_ + inside{t}_ * partBefore(low_, depth{t}_) : y;
        }
//@end
      }
      to = from;
    }
    if (EVEN > 0) {
      low_ = partOf(to);
//@each t TARGETS
      line{t} += before{t}_ + inside{t}_ * partBefore(low_, depth{t}_);
//@end
    }
//@each t TARGETS
    sum{t} += share * line{t};
//@end
  }
//@each t TARGETS
  spectrum{t} = sum{t};
//@end
}
