// A line of sight through a medium that varies through its body: see sim/model/field.hpp. It is cut into steps, the farthest first, each passed as an even
// layer (sim/radiometry/glsl/medium.glsl), and into slabs where something else begins or ends on it: of each it leaves what it lets through and what it adds.
// Which elements it may meet is listed by tiles. Air is worked out for a stretch of many steps where it is nearly even on it.
//@use sim/radiometry/glsl/medium.glsl
//@constants
//@use sim/render/geometry/glsl/volume_ray.glsl
//@use sim/render/assembly/glsl/node_block.glsl
//@use sim/radiometry/glsl/footprint.glsl
//@use sim/render/geometry/glsl/field_tiles.glsl
//@use sim/render/media/glsl/field_lines.glsl
//@use sim/render/media/glsl/listed_entry.glsl
layout(binding = 5) uniform samplerBuffer fieldSpectra;  // sim/render/media/field_tables.hpp says what is where
layout(binding = 17) uniform samplerBuffer fieldTexels;  // of the field's own shader
layout(binding = 18) uniform usamplerBuffer list;        // pixel, which of its lines, passage of the farthest slab, its words
layout(binding = 22) uniform usamplerBuffer words;       // number of slabs, then where each ends on the near side (floats: t; not of the last)
uniform int drawIndex;                                   // of the field
uniform vec2 fieldRange;   // from the camera to its nearest and farthest [m], where it is so far that the air across it is nearly even; else 0, 0
uniform vec4 planckRange;  // first 1 / T, entries per unit of it, texel of the first, number of the last
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
// Of the step gathered last, which is the next to be seen through: amounts; 1 / temperature [1/K] (0: nothing is there), factor of own radiance, share of the
// sun, amount towards it.
vec4 nextLow_;
vec4 nextHigh_;
vec4 next_;
vec3 nextTwo_;     // two temperatures that send what all of its parts do, the share of the second: twoTemperatures()
float driftPerK_;  // of the step at hand: driftOf()
// Of the parts of a step where a field keeps their temperatures apart (fieldMixes): sums of weight x powers of their difference from the first one's, that; the
// range of them.
vec3 moments_;
float firstOf_;
vec2 range_;

void addTemperature(float weight, float temperature) {
  if (weight_ <= 0.0) {
    firstOf_ = temperature;
    range_ = vec2(temperature);
  }
  float d = temperature - firstOf_;
  moments_ += weight * vec3(d, d * d, d * d * d);
  range_ = vec2(min(range_.x, temperature), max(range_.y, temperature));
}
//@slot field

// Drops scatter many times: what their field says of the step gathered last, and of that at hand.
//@each d DROPS
CloudStep nextDrops_, drops_;
//@end

//@slot targets
//@slot path
Draw field_;
ivec2 pixel_;
int list_, listed_, first_, cuts_;  // the tile's elements, and steps of its lines; texel of the first that the line meets
uvec2 met_;                         // of the first 64 of the list, those that the line meets
int steps_;                         // of the line
bool together_;                     // on one stretch of air
int slabs_, words_;                 // of the line
int passage_, apart_;               // of the slab at hand; from one to the next
float cosScatter_;
float gain_, sun_, sunAmount_;
int black_, hotter_;  // rows of Planck's law: of the temperature, of the hotter one where there are two
float blackMix_, hotterMix_, hotterShare_;
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

// What the line meets, before what the pixel's middle sees: a line beside it may pass the horizon of a plane, or what stands on it.
void prepareLine(vec2 place) {
  prepareRay(vec2(pixel_) + 0.5);
  float end = endOfRay(field_, pixel_);
  prepareRay(place);
  d_ = inBody(field_, ray_);
  q_ = pointOnPlane(field_);
  perT_ = rayLength_;
  enter_ = kFar;
  leave_ = -kFar;
  first_ = -1;
  met_ = uvec2(0u);
  for (int e = 0; e < listed_; ++e) {
    int element = int(texelFetch(fieldTiles, list_ + e).x);
    vec2 chord = fieldChord(element);
    if (!(chord.y > chord.x)) continue;
    if (first_ < 0) first_ = element;
    enter_ = min(enter_, chord.x);
    leave_ = max(leave_, chord.y);
    if (e < 32) met_.x |= 1u << uint(e);
    else if (e < 64) met_.y |= 1u << uint(e - 32);
  }
  enter_ = max(enter_, -planeOf(field_));  // the camera
  leave_ = min(leave_, end);
  steps_ = leave_ > enter_ && first_ >= 0 ? cuts_ : 0;
  if (steps_ > 0) fieldLine(first_, steps_);
  cosScatter_ = dot(ray_, view.sun.xyz) / rayLength_;
  together_ = fieldRange.y > 0.0 || (leave_ - enter_) * rayLength_ < kEven * (planeOf(field_) + enter_) * rayLength_;
}

void addMet(int from, uint met, float enter, float leave) {
  while (met != 0u) {
    int e = findLSB(met);
    met &= met - 1u;
    fieldAdd(int(texelFetch(fieldTiles, list_ + from + e).x), enter, leave);
  }
}

void gatherStep(float from, float to) {
  amountLow_ = vec4(0.0);
  amountHigh_ = vec4(0.0);
  weight_ = heat_ = gained_ = lit_ = shade_ = 0.0;
  moments_ = vec3(0.0);
  addMet(0, met_.x, from, to);
  addMet(32, met_.y, from, to);
  for (int e = 64; e < listed_; ++e) fieldAdd(int(texelFetch(fieldTiles, list_ + e).x), from, to);
  nextLow_ = amountLow_;
  nextHigh_ = amountHigh_;
  next_ = weight_ > 0.0 ? vec4(weight_ / heat_, vec3(gained_, lit_, shade_) / weight_) : vec4(0.0);
//@each d DROPS
  nextDrops_ = cloudStep();
//@end
  if (fieldMixes && weight_ > 0.0) {
    vec3 m = moments_ / weight_;
    nextTwo_ = twoTemperatures(heat_ / weight_, m.y - m.x * m.x, m.z - 3.0 * m.y * m.x + 2.0 * m.x * m.x * m.x);
    nextTwo_.xy = clamp(nextTwo_.xy, range_.xx, range_.yy);
  }
}

// How 1 / temperature changes over a step to its far end, by that and the lengths of it (y) and of what touches it, farther (x) and nearer (z):
// sim/model/field_drift.hpp.
float driftOf(vec3 inverse, vec3 size) {
  float far = (inverse.x - inverse.y) * size.y / (size.y + size.x), near = (inverse.y - inverse.z) * size.y / (size.y + size.z);
  return inverse.x > 0.0 && inverse.z > 0.0 && near * far > 0.0 ? 2.0 * sign(near) * min(abs(near), abs(far)) : 0.0;
}

void setBlack(float inverse, out int row, out float part) {
  float place = clamp((inverse - planckRange.x) * planckRange.y, 0.0, planckRange.w);
  int entry = min(int(place), int(planckRange.w) - 1);
  row = int(planckRange.z) + entry * FOURS;
  part = place - float(entry);
}

// A step that was gathered.
void prepareStep(float from, float to, vec4 low, vec4 high, vec4 state, vec3 two) {
  float inverse = state.x > 0.0 ? state.x : 1.0 / 300.0, temperature = 1.0 / inverse;
  gain_ = state.y;
  sun_ = state.z;
  sunAmount_ = state.w;
//@each g MIXTURES
  amount{g}_ = {g} < 4 ? low[{g} % 4] : high[{g} % 4];
  {
    vec4 gas = texelFetch(fieldSpectra, {g});  // first texel of its levels, number of levels, first texel of what else it has
    float passed = -1.0;
//@each v LEVEL_FOURS
    passed += dot(vec4(greaterThanEqual(vec4(temperature), gasLevels[{g} * LEVEL_FOURS + {v}])), vec4(1.0));
//@end
    int low = int(clamp(passed, 0.0, max(gas.y - 2.0, 0.0)));
    int first = MIXTURES + 4 * LEVEL_FOURS * {g} + low;
    float at = texelFetch(fieldSpectra, first).x, next = texelFetch(fieldSpectra, first + 1).x;
    levelMix{g}_ = gas.y < 2.0 ? 0.0 : clamp((temperature - at) / (next - at), 0.0, 1.0);
    level{g}_ = int(gas.x) + low * FOURS;
  }
//@end
  setBlack(fieldMixes && state.x > 0.0 ? 1.0 / two.x : inverse, black_, blackMix_);
  if (fieldMixes) setBlack(state.x > 0.0 ? 1.0 / two.y : inverse, hotter_, hotterMix_);
  hotterShare_ = two.z;
  low_ = partOf(from);
  high_ = partOf(to);
}

// What a step has of the gases at four nodes: optical depth; emission in its middle x depth, and what that changes by to its far end; sunlight turned to the
// camera x depth.
struct Matter {
  vec4 depth, emitted, drifting, turned;
};

Matter matterAt(int four) {
  vec4 warmer = texelFetch(fieldSpectra, black_ + four), cooler = texelFetch(fieldSpectra, black_ + FOURS + four);
  vec4 black = mix(warmer, cooler, blackMix_), slope = cooler - warmer;
  if (fieldMixes) {
    warmer = texelFetch(fieldSpectra, hotter_ + four);
    cooler = texelFetch(fieldSpectra, hotter_ + FOURS + four);
    black = mix(black, mix(warmer, cooler, hotterMix_), hotterShare_);
    slope = mix(slope, cooler - warmer, hotterShare_);
  }
  // No end sends less than nothing.
  vec4 drift = clamp(slope * (driftPerK_ * planckRange.y), -2.0 * black, 2.0 * black);
  Matter m = Matter(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
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
      m.drifting += own * thermal * drift;
      m.turned += own * sun_ * sunlight * phase * exp(-min(sunAmount_ * each, vec4(80.0)));
    } else {
      m.emitted += own * black;
      m.drifting += own * drift;
    }
  }
//@end
  // Of drops it is another law: all of their light, by the numbers of their place.
//@each d DROPS
  int row = int(texelFetch(fieldSpectra, 0).w) + 10 * four;
  vec4 albedo = texelFetch(fieldSpectra, row), asymmetry = texelFetch(fieldSpectra, row + 1), irradiance = texelFetch(fieldSpectra, row + 2);
  vec4 above = texelFetch(fieldSpectra, row + 3), below = texelFetch(fieldSpectra, row + 4), coordinate = texelFetch(fieldSpectra, row + 9);
  vec4 first = texelFetch(fieldSpectra, row + 5), second = texelFetch(fieldSpectra, row + 6), third = texelFetch(fieldSpectra, row + 7),
       fourth = texelFetch(fieldSpectra, row + 8), extinction = max(m.depth / max(amount0_, 1.0e-30), vec4(1.0e-6));
  for (int j = 0; j < 4; ++j) {
    CloudOptics optics = cloudOpticsBy(extinction[j], albedo[j], asymmetry[j], vec4(first[j], second[j], third[j], fourth[j]), coordinate[j]);
    vec2 sent = cloudSource(drops_, optics, above[j], below[j], black[j], cosScatter_);
    m.emitted[j] = m.depth[j] * sent.y;
    m.turned[j] = m.depth[j] * sun_ * irradiance[j] * sent.x;
  }
//@end
  return m;
}

// Of a source that changes by 1 over an even layer of a depth, what is seen beyond that of its middle, for each of that depth: (g(d) - (1 - exp(-d))/2)/d with
// g(d) = (1 - exp(-d) (1 + d))/d (NodeSum::segment), to 3 % up to a depth of 1 and to 9 % beyond.
vec4 drifted(vec4 depth) { return -depth / (12.0 + depth * (6.0 + 1.8 * depth)); }

vec4 passed_;  // what a step lets through

// A step: what comes from behind, less what air alone would show to its far end, is what the result is to its near end.
//   y' = y exp(-a) + I E(a + g)/E(g) + tau S a E(a + g),   E(x) = (1 - exp(-x))/x: as mediumRadiance() has it, I radiance of the air on the step.
// EVEN: the air's depth g on a step is so small that E(a) does for both, and the step is seen through the air before its middle.
vec4 stepped(vec4 behind, vec4 tau, vec4 airDepth, vec4 inside, vec4 sunlit, int four) {
  Matter m = matterAt(four);
  vec4 passed = exp(-min(m.depth, vec4(80.0)));
  passed_ = passed;
  if (EVEN > 0) {
    vec4 upTo = airDepth * (0.5 * (low_ + high_)), fallen = 1.0 - upTo * (1.0 - 0.5 * upTo);
    vec4 light = inside * ((high_ - low_) + (0.5 * ((1.0 - high_) * high_ - (1.0 - low_) * low_)) * airDepth);
    vec4 mean = mix((1.0 - passed) / m.depth, 1.0 - 0.5 * m.depth, lessThan(m.depth, vec4(2.0e-3)));
    return passed * behind + mean * (light + fallen * (tau * m.emitted + sunlit * m.turned)) + drifted(m.depth) * fallen * tau * m.drifting;
  }
  vec4 beside = airDepth * (high_ - low_), clear = exp(-min(beside, vec4(80.0)));
  vec4 mean = meanOf(m.depth + beside, passed * clear), upTo = airDepth * low_, fallen = 1.0 - upTo * (1.0 - 0.5 * upTo);
  vec4 light = inside * (partBefore(high_, airDepth) - partBefore(low_, airDepth));
  return passed * behind + light * mean / meanOf(beside, clear) +
         fallen * (mean * (tau * m.emitted + sunlit * m.turned) + drifted(m.depth + beside) * tau * m.drifting);
}

//@each t TARGETS
vec4 through{t}, own{t};  // of the slab at hand, from its far end on
//@end

// At the far end of a slab nothing of it is passed yet.
void openSlab() {
//@each t TARGETS
  through{t} = vec4(1.0);
  own{t} = vec4(0.0);
//@end
}

// Steps pass what is seen less what air alone would show to their far end.
void openAir(float far) {
  high_ = partOf(far);
//@each t TARGETS
  own{t} -= before{t}_ + inside{t}_ * partBefore(high_, depth{t}_);
//@end
}

void closeAir(float near) {
  low_ = partOf(near);
//@each t TARGETS
  own{t} += before{t}_ + inside{t}_ * partBefore(low_, depth{t}_);
//@end
}

void closeSlab() {
//@each t TARGETS
  storePassage(passage_, {t}, through{t}, own{t});
//@end
  passage_ += apart_;
  openSlab();
}

// The near end of a slab, where another one begins; of a step.
float endOfSlab(int slab) { return slab + 1 < slabs_ ? uintBitsToFloat(texelFetch(words, words_ + 1 + slab).x) : -kFar; }
float endOfStep(int k) { return fieldCut((float(steps_) - 1.0 - float(k)) / float(steps_)); }

void main() {
  uvec4 entry = texelFetch(list, listedEntry());
  pixel_ = ivec2(entry.x & 0xffffu, entry.x >> 16);
  passage_ = int(entry.z);
  words_ = int(entry.w);
  slabs_ = int(texelFetch(words, words_).x);
  FieldTile tile = fieldTileAt(pixel_);
  list_ = tile.list;
  listed_ = tile.listed;
  cuts_ = tile.steps;
  int lines = linesOf(pixel_);
  apart_ = countOfLines(lines);
  field_ = drawAt(uint(drawIndex));
  if (EVEN > 0) {
    prepareRay(vec2(pixel_) + 0.5);  // air along the pixel's middle
    setAir(fieldRange.x, fieldRange.y);
  }
  prepareLine(placeOfLine(lines, int(entry.y)));
  openSlab();
  int slab = 0, k = 0;
  float slabEnd = endOfSlab(0), to = leave_;
  for (; slab + 1 < slabs_ && !(slabEnd < to); slabEnd = endOfSlab(slab)) {
    closeSlab();
    ++slab;
  }
  float stepEnd = steps_ > 0 ? endOfStep(0) : to, from = max(stepEnd, slabEnd);
  vec3 inverse = vec3(0.0), size = vec3(1.0, 1.0, to - from);
  bool open = false;  // a stretch of air
  if (steps_ > 0) gatherStep(from, to);
  while (k < steps_) {
    vec4 amountsLow = nextLow_, amountsHigh = nextHigh_, state = next_;
    vec3 two = nextTwo_;
//@each d DROPS
    drops_ = nextDrops_;
//@end
    bool ends = slab + 1 < slabs_ && from <= slabEnd;
    if (from <= stepEnd) {
      ++k;
      if (k < steps_) stepEnd = endOfStep(k);
    }
    if (ends) {
      ++slab;
      slabEnd = endOfSlab(slab);
    }
    float nearer = from;
    next_ = vec4(0.0);
    if (k < steps_) {
      nearer = max(stepEnd, slabEnd);
      gatherStep(nearer, from);
    }
    inverse = vec3(inverse.y, state.x, next_.x);
    size = vec3(size.yz, from - nearer);
    driftPerK_ = driftOf(inverse, size);
    if (!open) {
      if (EVEN == 0) setAir((planeOf(field_) + (together_ ? enter_ : from)) * rayLength_, (planeOf(field_) + to) * rayLength_);
      openAir(to);
      open = true;
    }
    prepareStep(from, to, amountsLow, amountsHigh, state, two);
//@each t TARGETS
    own{t} = stepped(own{t}, tau{t}_, depth{t}_, inside{t}_, sunlit{t}_, fourOf({t}));
    through{t} *= passed_;
//@end
    if (!together_ || ends || k >= steps_) {
      closeAir(from);
      open = false;
    }
    if (ends) closeSlab();
    to = from;
    from = nearer;
  }
  for (; slab < slabs_; ++slab) closeSlab();
}
