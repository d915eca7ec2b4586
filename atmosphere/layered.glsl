//@use sim/radiometry/glsl/exponential.glsl
//@use sim/radiometry/glsl/shell.glsl
// Layered air: -ln tau = sum of c_k W_k^a_k over the absorbers k, four to a vector. What a camera's way holds (logarithm of the mean density)
// and sends beyond air of one temperature comes from a table by elevation and range, made in double precision for each view
// (atmosphere/layered_gpu.hpp); ways on to lights and to the sun from tables by height. Amounts of both legs are added before the
// power: a band does not decay exponentially.
layout(std140, binding = 3) uniform AirBlock {
  vec4 grid;       // root of the first elevation's sine, entries per unit of it; scale of ranges [m], entries per unit of ln(1 + range / scale)
  vec4 azimuth;    // first cosine of the azimuth to the sun times the sun's horizontal part, entries per unit of it; number of elevations, of ranges
  vec4 more;       // number of azimuths; by how much the height over which lines are straight is above that of the camera [m]
  vec4 heights;    // bottom [m], entries per root of a metre; sine of the first sun elevation, 1 / step to the next
  vec4 exponent[AIR_VECTORS];
  vec4 asymmetry[AIR_VALUES];  // of nodes, or of channels
  vec4 black[AIR_BLACKS];  // of nodes: radiance of a black body of the air's temperature at the camera
  vec4 shells[max(AIR_SHELLS, 1)];  // from, to [m], amount per metre, which
} air;
//@slot air_extinction
// [elevation][range, space last][vector], then [height][sun elevations][vector], then [finer height][density, column above][vector], then where lines bend
// [finer height](height over which lines are straight, and back)
layout(binding = 20) uniform samplerBuffer airAmounts;
layout(binding = 21) uniform samplerBuffer airRadiance;  // [azimuth][elevation][range, space last][part][value]

int airElevations() { return int(air.azimuth.z); }
int airRanges() { return int(air.azimuth.w); }

struct AirPath {
//@each v AIR_VECTORS
  vec4 w{v};            // amounts
  vec4 u{v};            // the same to their powers
//@end
  int cell;             // of the table
  int next;             // steps to the next range
  vec2 mixed;
};

// Length of ray outside the air before it begins [m].
float airEntry() {
  float h = view.up.w, q2 = (view.earth.y - h) * (2.0 * view.earth.x + view.earth.y + h), b = (view.earth.x + h) * sinElevation_;
  if (q2 >= 0.0) return 0.0;
  float root = b * b + q2;
  return root <= 0.0 || b >= 0.0 ? kFar : -q2 / (sqrt(root) - b);
}

// What shells have on a way from a height over which lines are straight. Their exponent is 1.
void addShells(inout AirPath p, float height, float sine, float range) {
//@each s AIR_SHELLS
  {
    vec4 shell = air.shells[{s}];
    float held = shell.z * lengthInShell(shell.x, shell.y, height, sine, range, view.earth.x);
//@each v AIR_VECTORS
    {
      vec4 own = held * vec4(equal(vec4(shell.w), vec4(4 * {v}, 4 * {v} + 1, 4 * {v} + 2, 4 * {v} + 3)));
      p.w{v} += own;
      p.u{v} += own;
    }
//@end
  }
//@end
}

AirPath airFromCamera(float range) {
  AirPath p;
  bool space = range >= kFar;
  float length = max(range - airEntry(), 0.0);
  float x = clamp((sign(sinElevation_) * sqrt(abs(sinElevation_)) - air.grid.x) * air.grid.y, 0.0, float(airElevations() - 1));
  float y = clamp(log(1.0 + min(length, 1.0e9) / air.grid.z) * air.grid.w, 0.0, float(airRanges() - 1));
  int e = min(int(x), airElevations() - 2), r = space ? airRanges() : min(int(y), airRanges() - 2);
  p.cell = e * (airRanges() + 1) + r;
  p.next = space ? 0 : 1;
  p.mixed = vec2(x - float(e), space ? 0.0 : y - float(r));
  float logLength = space ? 0.0 : log(length * 1.0e-3);
//@each v AIR_VECTORS
  {
    int low = p.cell * AIR_VECTORS + {v}, step = p.next * AIR_VECTORS, high = low + (airRanges() + 1) * AIR_VECTORS;
    vec4 l = mix(mix(texelFetch(airAmounts, low), texelFetch(airAmounts, low + step), p.mixed.y),
                 mix(texelFetch(airAmounts, high), texelFetch(airAmounts, high + step), p.mixed.y), p.mixed.x) + logLength;
    p.w{v} = length > 0.0 ? exp(l) : vec4(0.0);
    p.u{v} = length > 0.0 ? exp(l * air.exponent[{v}]) : vec4(0.0);
  }
//@end
  addShells(p, view.up.w + air.more.y, sinElevation_, range);
  return p;
}

AirPath airBeyond(AirPath near, float nearRange, float height, float sinElevation, float length) { return airFromCamera(nearRange + length); }

// Entry of a table by height: linear between heights, which lie closer together near the ground.
void airHeight(float height, out int entry, out float mixed) {
  int last = AIR_HEIGHTS - 1;
  float t = clamp(sqrt(max(height - air.heights.x, 0.0)) * air.heights.y, 0.0, float(last));
  entry = min(int(t), last - 1);
  float from = float(entry), t2 = t * t, from2 = from * from;
  mixed = clamp((t2 - from2) / (2.0 * from + 1.0), 0.0, 1.0);
}
int airHeights() { return airElevations() * (airRanges() + 1) * AIR_VECTORS; }

// The logarithm of the density at a height (0), the column above (1).
vec4 airByHeight(float height, int what, int v) {
  int entry;
  float m;
  airHeight(height, entry, m);
  int at = airHeights() + (AIR_HEIGHTS * AIR_SUNS + 2 * entry + what) * AIR_VECTORS + v;
  return mix(texelFetch(airAmounts, at), texelFetch(airAmounts, at + 2 * AIR_VECTORS), m);
}
// Below the lowest height the air is as dense as there.
vec4 airLowest(int v) { return exp(texelFetch(airAmounts, airHeights() + AIR_HEIGHTS * AIR_SUNS * AIR_VECTORS + v)); }
vec4 airColumn(float height, int v, vec4 lowest) { return airByHeight(height, 1, v) + max(air.heights.x - height, 0.0) * 1.0e-3 * lowest; }
vec4 airDensity(float height, int v) { return height > view.earth.y ? vec4(0.0) : exp(airByHeight(height, 0, v)); }

AirPath airRaised(AirPath p) {
//@each v AIR_VECTORS
  p.u{v} = exp(log(max(p.w{v}, vec4(1.0e-30))) * air.exponent[{v}]);
//@end
  return p;
}

// Amounts towards an elevation from the level on, cubic between elevations as SunLegs::upwards().
struct AirLeg {
//@each v AIR_VECTORS
  vec4 w{v};
//@end
};
AirLeg airUpwards(float height, float sine) {
  AirLeg leg;
  int entry;
  float m, x = clamp((sine - air.heights.z) * air.heights.w, 0.0, float(AIR_SUNS - 1));
  airHeight(height, entry, m);
  int e = clamp(int(x) - 1, 0, max(AIR_SUNS - 4, 0)), at = airHeights() + (entry * AIR_SUNS + e) * AIR_VECTORS;
  float f = x - float(e);
  vec4 weight = vec4((f - 1.0) * (f - 2.0) * (3.0 - f) / 6.0, f * (f - 2.0) * (f - 3.0) / 2.0, f * (f - 1.0) * (3.0 - f) / 2.0,
                     f * (f - 1.0) * (f - 2.0) / 6.0);
//@each v AIR_VECTORS
  {
    int low = at + {v}, above = low + AIR_SUNS * AIR_VECTORS;
    vec4 root = vec4(0.0);
//@each j 4
    root += weight[{j}] * mix(texelFetch(airAmounts, low + {j} * AIR_VECTORS), texelFetch(airAmounts, above + {j} * AIR_VECTORS), m);
//@end
    root = max(root, vec4(0.0));
    leg.w{v} = root * root;
  }
//@end
  return leg;
}

// Between a height and that over which lines are straight.
float airBent(float height, int what) {
  int entry;
  float m;
  airHeight(height, entry, m);
  int at = airHeights() + AIR_HEIGHTS * (AIR_SUNS + 2) * AIR_VECTORS + entry;
  return mix(texelFetch(airAmounts, at)[what], texelFetch(airAmounts, at + 1)[what], m);
}

// The lowest point of a way that goes down first.
float airLowestOn(float height, float sine) {
  float h = AIR_BENDS > 0 ? airBent(height, 0) : height;
  float lowest = h - (view.earth.x + h) * sine * sine / (1.0 + sqrt(max(1.0 - sine * sine, 0.0)));
  return AIR_BENDS > 0 ? airBent(lowest, 1) : lowest;
}

// A way that goes down first has twice what lies above its lowest point, less what lies behind it.
AirPath airToSun(AirPath camera, float height) {
  AirPath p = camera;
  if (AIR_SUNS == 0) return p;
  float sine = sunElevation_;
  AirLeg leg = airUpwards(height, abs(sine)), half_ = leg;
  if (sine < 0.0) half_ = airUpwards(airLowestOn(height, sine), 0.0);
  // Below the lowest entry: evenly dense, as CPU and columns have it, on a way as if the earth were flat; no flatter than 0.6 degrees, where it is not.
  float below = max(air.heights.x - height, 0.0) / max(sine, 0.01) * 1.0e-3;
//@each v AIR_VECTORS
  leg.w{v} += below * airLowest({v});
  p.w{v} += sine < 0.0 ? max(2.0 * half_.w{v} - leg.w{v}, vec4(0.0)) : leg.w{v};
//@end
  if (AIR_SHELLS > 0) addShells(p, AIR_BENDS > 0 ? airBent(height, 0) : height, sine, kFar);
  return airRaised(p);
}

// Between two heights what one has above it more than the other, or, where these are near each other, the density between them. In a few pieces, for ways
// bend away from the ground; shorter ones at the lower end, where there is most air.
AirPath airToLight(AirPath camera, float height, float sinElevation, float distance) {
  AirPath p = camera;
  float curved = 0.5 / view.earth.x, rise = distance * (sinElevation + distance * curved);
  bool level = abs(rise) < 300.0;
  float h0 = height, s0 = 0.0;
//@each v AIR_VECTORS
  vec4 lowest{v} = airLowest({v}), column{v} = airColumn(height, {v}, lowest{v});
//@end
//@each k AIR_PIECES
  {
    float u = float({k} + 1) / float(AIR_PIECES), s1 = distance * (level ? u : rise > 0.0 ? u * u : 1.0 - (1.0 - u) * (1.0 - u));
    float h1 = height + s1 * (sinElevation + s1 * curved), middle = 0.5 * (s0 + s1);
    middle = height + middle * (sinElevation + middle * curved);
    bool apart = abs(h1 - h0) > 50.0;
    float length_km = (s1 - s0) * 1.0e-3, perRise = 1.0e3 / (apart ? h1 - h0 : 1.0);
//@each v AIR_VECTORS
    vec4 next{v} = airColumn(h1, {v}, lowest{v});
    p.w{v} += length_km * (apart ? (column{v} - next{v}) * perRise : airDensity(middle, {v}));
    column{v} = next{v};
//@end
    h0 = h1;
    s0 = s1;
  }
//@end
  if (AIR_SHELLS > 0) addShells(p, AIR_BENDS > 0 ? airBent(height, 0) : height, sinElevation, distance);
  return airRaised(p);
}

Real airDepth(int i, AirPath p) {
  Real depth = 0.0;
//@each v AIR_VECTORS
  depth += dot(airExtinction(i * AIR_VECTORS + {v}), p.u{v});
//@end
  return depth;
}

// What air of one temperature sends: with it the balance of a world of that temperature holds to rounding, whatever the tables lose.
Real airBlack(int i, Real depth) { return air.black[i / 4][i % 4] * oneMinusExp(depth); }

Real pathTransmittance(int i, AirPath p) { return exp(-airDepth(i, p)); }

Real pathDepth(int i, AirPath near, AirPath far) { return max(airDepth(i, far) - airDepth(i, near), 0.0); }

// Four nodes or channels between the four entries of a table; of one azimuth.
vec4 airPart(AirPath p, int azimuth, int part, int four) {
  int size = AIR_PARTS * AIR_VALUES, low = (azimuth * airElevations() * (airRanges() + 1) + p.cell) * size + part * AIR_VALUES + four;
  int step = p.next * size, high = low + (airRanges() + 1) * size;
  return mix(mix(texelFetch(airRadiance, low), texelFetch(airRadiance, low + step), p.mixed.y),
             mix(texelFetch(airRadiance, high), texelFetch(airRadiance, high + step), p.mixed.y), p.mixed.x);
}

// Henyey and Greenstein's phase function [1/sr] over 1 / (4 pi).
vec4 airHazePhase(vec4 g, float c) {
  vec4 chord = 1.0 + g * g - 2.0 * g * c;
  return (1.0 - g * g) * inversesqrt(chord) / chord;
}

// Emission less that of air of one temperature, and sunlight scattered by molecules, by haze and by haze again, each with its phase function [1/sr].
vec4 airValue(AirPath p, int four) {
  vec4 sum = airPart(p, 0, 0, four);
  if (AIR_PARTS > 1) {
    float c = dot(ray_, view.sun.xyz) / rayLength_;
    vec4 g = air.asymmetry[four];
    vec4 molecules = airPart(p, 0, 1, four), haze = airPart(p, 0, 2, four), again = AIR_PARTS > 3 ? airPart(p, 0, AIR_PARTS - 1, four) : vec4(0.0);
    if (AIR_AZIMUTHS > 1) {
      // The sun's height over far air depends on the azimuth it is seen under.
      float across = (c - sinElevation_ * dot(view.up.xyz, view.sun.xyz)) * inversesqrt(max(1.0 - sinElevation_ * sinElevation_, 1.0e-8));
      float z = clamp((across - air.azimuth.x) * air.azimuth.y, 0.0, air.more.x - 1.0);
      int a = min(int(z), int(air.more.x) - 2);
      molecules = mix(airPart(p, a, 1, four), airPart(p, a + 1, 1, four), z - float(a));
      haze = mix(airPart(p, a, 2, four), airPart(p, a + 1, 2, four), z - float(a));
      if (AIR_PARTS > 3) again = mix(airPart(p, a, AIR_PARTS - 1, four), airPart(p, a + 1, AIR_PARTS - 1, four), z - float(a));
    }
    sum += 0.0596831037 * (1.0 + c * c) * molecules + 0.0795774715 * airHazePhase(g, c) * haze;
    if (AIR_PARTS > 3) sum += 0.0795774715 * airHazePhase(g * g, c) * again;
  }
  return sum;
}
