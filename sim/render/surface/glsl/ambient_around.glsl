// Light from all around by spherical harmonics (sim/model/harmonic_response.hpp): L = rho mean(L_in) + sum of w_lk L_l(a_k) + D rest_blur(aim).
// Of a place, a slot: the elevation of its horizon and the azimuth of its grid's first entries [turns]; by node 25 coefficients in seven vec4; by blur
// (of lobes, of sharp lobes, by a cosine) and entry of its grid the rest at the nodes, four to a texel.
//@use sim/render/assembly/glsl/view_block.glsl
//@use sim/radiometry/glsl/harmonics.glsl
//@use sim/radiometry/glsl/arc_tangent.glsl
layout(binding = 31) uniform samplerBuffer surroundings;
int around_;  // where that of the body's place begins
const int blurEntries = (AROUND_ABOVE + AROUND_BELOW) * AROUND_AZIMUTHS * NODE_TEXELS;
const int slotTexels = 1 + 7 * NODES + (AROUND_BLURS + AROUND_SHARP_BLURS + 1) * blurEntries;
Harmonics4 to0_, to1_, to2_, to3_, to4_;  // at the directions a_k
ivec4 restAt_[AROUND_GROUPS];  // of each group's aim
vec4 restMix_[AROUND_GROUPS];
float further_[AROUND_GROUPS], most_[AROUND_GROUPS];  // from the number of a blur to that of its table, up to the last
ivec4 mattAt_;
vec4 mattMix_, matt_;
int mattOf_;
int restOf_, sharper_;  // the texel of nodes that has been read, and about which blur
vec4 restNear_, restFar_;
//@each i AROUND_KEPT
float mean{i}_, shaped{i}_;  // what the reflectance multiplies at a node, and what it doesn't
//@end
int response0_, response1_;
float responseMix_;

// From the body's frame to the scenario's.
vec3 localOf(vec3 v) {
  vec3 c = draw_.row0.xyz * v.x + draw_.row1.xyz * v.y + draw_.row2.xyz * v.z;
  return vec3(dot(view.east.xyz, c), dot(view.north.xyz, c), dot(cross(view.east.xyz, view.north.xyz), c));
}

// From x towards y, -pi to pi.
float azimuthOf(vec3 d) {
  float turn = arcTangent(abs(d.y) / max(abs(d.x), 1.0e-12));
  turn = d.x < 0.0 ? 3.1415927 - turn : turn;
  return d.y < 0.0 ? -turn : turn;
}

// Entries of the grid about a direction: sim/model/direction_grid.cpp.
void placesOf(vec3 d, out ivec4 places, out vec4 shares) {
  vec2 place = texelFetch(surroundings, around_).xy;
  float horizon = place.x;
  float flat_ = length(d.xy), elevation = sign(d.z) * arcTangent(abs(d.z) / max(flat_, 1.0e-9));
  bool up = elevation >= horizon;
  int rings = up ? AROUND_ABOVE : AROUND_BELOW;
  float whole = up ? 1.5707963 - horizon : 1.5707963 + horizon;
  float x = sqrt(clamp(abs(elevation - horizon) / whole, 0.0, 1.0)) * float(rings - 1);
  int ring = min(int(x), rings - 2);
  float across = x - float(ring);
  float turn = AROUND_AZIMUTHS > 1 ? azimuthOf(d) * 0.15915494 - place.y : 0.0;
  turn = (turn - floor(turn)) * float(AROUND_AZIMUTHS);
  int first = min(int(turn), AROUND_AZIMUTHS - 1);
  float round = turn - float(first);
  int next = first + 1 == AROUND_AZIMUTHS ? 0 : first + 1;
  int row = (ring + (up ? 0 : AROUND_ABOVE)) * AROUND_AZIMUTHS;
  places = around_ + 1 + 7 * NODES + NODE_TEXELS * ivec4(row + first, row + next, row + AROUND_AZIMUTHS + first, row + AROUND_AZIMUTHS + next);
  shares = vec4((1.0 - across) * (1.0 - round), (1.0 - across) * round, across * (1.0 - round), across * round);
}

int responsesOfGroup() { return int(material_.response.z) * (4 * NODES + 1); }
vec4 responseByView(int at) { return mix(texelFetch(hemispherical, response0_ + at), texelFetch(hemispherical, response1_ + at), responseMix_); }
// By view angle: an aim, then four of each node.
vec4 responseAt(int at) {
  vec4 own = responseByView(at);
  return STATES == 0 ? own : mix(own, responseByView(at + nextState(int(material_.response.y) * responsesOfGroup())), stateMix_);
}

void prepareDirections() {
  around_ = int(draw_.fine.w) * slotTexels;
  vec3 normal = localOf(normal_);
  to0_ = harmonicsAt(normal);
  placesOf(normal, mattAt_, mattMix_);
  mattAt_ += (AROUND_BLURS + AROUND_SHARP_BLURS) * blurEntries;
  mattOf_ = -1;
  if (AROUND_PLAIN == 1) return;
  vec3 viewer = localOf(toViewer_), flat_ = viewer - dot(viewer, normal) * normal;
  float size = length(flat_);
  // Straight from above there is no plane, and nothing that asks for one.
  vec3 across = size > 1.0e-6 ? flat_ / size : normalize(cross(normal, abs(normal.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
  to1_ = harmonicsAt(0.30901699 * normal + 0.95105652 * across);
  to2_ = harmonicsAt(-0.80901699 * normal + 0.58778525 * across);
  to3_ = harmonicsAt(0.80901699 * normal + 0.58778525 * across);
  to4_ = harmonicsAt(-0.30901699 * normal + 0.95105652 * across);
  restOf_ = -1;
  float last = float(material_.response.z - 1u);
  float x = min(angleFromChord(normal_, toViewer_) * 0.63661977, 1.0) * last;
  int low = min(int(x), max(int(last) - 1, 0));
  responseMix_ = x - float(low);
  response0_ = int(material_.response.x) + (4 * NODES + 1) * low;
  response1_ = response0_ + (last > 0.0 ? 4 * NODES + 1 : 0);
  float cosine = clamp(dot(normal, viewer), 0.0, 1.0), sine = sqrt(1.0 - cosine * cosine), aside = normal.x * across.y - normal.y * across.x;
  for (int g = 0; g < AROUND_GROUPS; ++g) {
    if (g >= int(material_.response.y)) break;
    // Tilt and stretch of its lobe, and is it sharp?
    vec3 aim = responseAt(g * responsesOfGroup()).xyz;
    float ct = cos(aim.x), st = sin(aim.x), c = cosine * ct + sine * st, s = sine * ct - cosine * st;
    placesOf(c * normal - s * across, restAt_[g], restMix_[g]);
    float along = c * across.z + s * normal.z, both = along * along + aside * aside;
    bool sharp_ = aim.z > 0.5;
    if (sharp_) restAt_[g] += AROUND_BLURS * blurEntries;
    most_[g] = float((sharp_ ? AROUND_SHARP_BLURS : AROUND_BLURS) - 1);
    further_[g] = (both > 1.0e-12 ? log2(1.0 + aim.y * (along * along - aside * aside) / both) : 0.0) - float(sharp_ ? AROUND_SHARP_FIRST : AROUND_FIRST);
  }
}

// What the harmonics leave of the light about a group's aim, between two blurs: four nodes are read at once, about the blur of the first.
float restAt(int g, float blur, int i) {
  float x = clamp(blur + further_[g], 0.0, most_[g]);
  if (restOf_ != i / 4) {
    restOf_ = i / 4;
    sharper_ = min(int(x), int(most_[g]) - 1);
    ivec4 at = restAt_[g] + sharper_ * blurEntries + restOf_;
    vec4 share = restMix_[g];
    restNear_ = share.x * texelFetch(surroundings, at.x) + share.y * texelFetch(surroundings, at.y) + share.z * texelFetch(surroundings, at.z) +
                share.w * texelFetch(surroundings, at.w);
    at += blurEntries;
    restFar_ = share.x * texelFetch(surroundings, at.x) + share.y * texelFetch(surroundings, at.y) + share.z * texelFetch(surroundings, at.z) +
               share.w * texelFetch(surroundings, at.w);
  }
  return mix(restNear_[i % 4], restFar_[i % 4], x - float(sharper_));
}

// What the harmonics leave of the light on a matt surface; four nodes are read at once.
float mattAt(int i) {
  if (mattOf_ != i / 4) {
    mattOf_ = i / 4;
    matt_ = mattMix_.x * texelFetch(surroundings, mattAt_.x + mattOf_) + mattMix_.y * texelFetch(surroundings, mattAt_.y + mattOf_) +
            mattMix_.z * texelFetch(surroundings, mattAt_.z + mattOf_) + mattMix_.w * texelFetch(surroundings, mattAt_.w + mattOf_);
  }
  return matt_[i % 4];
}

// Of node i: x times the reflectance, and y besides.
vec2 aroundAt(int i) {
  int at = around_ + 1 + 7 * i;
  LightHarmonics light;
  light.first = texelFetch(surroundings, at);
  light.second = texelFetch(surroundings, at + 1);
  light.third = texelFetch(surroundings, at + 2);
  if (AROUND_DEGREE > 2) light.fourth = texelFetch(surroundings, at + 3);
  if (AROUND_DEGREE > 3) {
    light.fifth = texelFetch(surroundings, at + 4);
    light.sixth = texelFetch(surroundings, at + 5);
    light.last = texelFetch(surroundings, at + 6).x;
  }
  float matt = mattAt(i), mean = 0.28209479 * light.first.x + matt, sum = 0.0;
  // Matt surfaces: A_l / pi is 2/3, 1/4, 0, -1/24.
  if (AROUND_PLAIN == 1) {
    mean += 0.66666667 * ofDegree1(light, to0_) + 0.25 * ofDegree2(light, to0_);
    if (AROUND_DEGREE > 3) mean -= 0.04166667 * ofDegree4(light, to0_);
    return vec2(isSurface_ * max(mean, 0.0), 0.0);  // rounding of what is nothing can lie below it
  }
  vec4 q0 = vec4(0.0, ofDegree1(light, to0_), ofDegree1(light, to1_), ofDegree2(light, to0_));
  vec4 q1 = vec4(ofDegree2(light, to1_), ofDegree2(light, to2_), 0.0, 0.0), q2 = vec4(0.0), q3 = vec4(0.0);
  if (AROUND_DEGREE > 2) {
    q1.zw = vec2(ofDegree3(light, to0_), ofDegree3(light, to1_));
    q2.xy = vec2(ofDegree3(light, to2_), ofDegree3(light, to3_));
  }
  if (AROUND_DEGREE > 3) {
    q2.zw = vec2(ofDegree4(light, to0_), ofDegree4(light, to1_));
    q3.xyz = vec3(ofDegree4(light, to2_), ofDegree4(light, to3_), ofDegree4(light, to4_));
  }
  int each = responsesOfGroup(), place = 4 * i + 1;
  for (int g = 0; g < AROUND_GROUPS; ++g, place += each) {
    if (g >= int(material_.response.y)) break;
    if (g > 0) restOf_ = -1;
    int k = int((material_.response.w >> uint(4 * g)) & 15u);
    vec4 r0 = responseAt(place), r3 = responseAt(place + 3);
    float own = dot(r0, q0) + dot(responseAt(place + 1), q1) + dot(r3, q3);
    // Of what is no lobe, a matt surface's share of the rest.
    if (r3.w > 0.0) own += r3.w * (restAt(g, r0.x / r3.w, i) - matt);
    if (AROUND_DEGREE > 2) own += dot(responseAt(place + 2), q2);
    sum += own * modifier_[k / 3][k % 3];
  }
  if (material_.response.y > 1u) restOf_ = -1;
  return isSurface_ * vec2(max(mean, 0.0), sum);
}

// Nodes that are written out one by one would each hold all of the above: these are looked at beforehand, in a loop.
void prepareAmbient() {
  prepareDirections();
  for (int i = 0; i < AROUND_KEPT; ++i) {
    vec2 own = aroundAt(i);
//@each i AROUND_KEPT
    if (i == {i}) mean{i}_ = own.x, shaped{i}_ = own.y;
//@end
  }
}

Real reflectedAmbient(Real reflectance, int i) {
//@each i AROUND_KEPT
  if (i == {i}) return reflectance * mean{i}_ + shaped{i}_;
//@end
  vec2 own = AROUND_KEPT > 0 ? vec2(0.0) : aroundAt(i);
  return reflectance * own.x + own.y;
}
