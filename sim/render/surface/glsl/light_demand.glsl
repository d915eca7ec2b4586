// Which program what a pixel sees takes: that with every light and its shadows where something may stand before one that matters, that with every light near a
// lamp, elsewhere that with the sun alone.
//@use sim/radiometry/glsl/sun_disc.glsl
//@use sim/render/assembly/glsl/light_list.glsl
vec3 point_, facet_, toViewer_;
uint triangle_;
bool wholeSun_;
//@slot shadow_list

const float kSunlit = 0.3;  // as in sim/render/surface/light_relevance.hpp
// Of its reach, squared, within which a lamp may make a picture bend: it is budget::kLamps (sim/plan/budget.hpp), so that farther off a lamp adds less
// than the accuracy, half of what a bend is.
const float kBends = 0.01;
const float kFewCasters = 16.0;  // of more, asking each costs about what the shadows do
bool sunlit_, smooth_;
vec2 lightAndDepth_;  // cosine to the sun, or -1; 1 / depth

// Of a light's entry; says besides whether the point is in full sunshine. Of a sun that is partly set the direction is another: who may hide it is not asked.
bool sunMayBeHidden(int entry, vec3 normal, float range) {
  vec4 listed = lightTexel(entry + 1);
  vec3 toSun = lightTexel(entry).xyz, up;
  float height = heightAt(range, up);
  wholeSun_ = SUN_SETS == 0 || sunShare(sunAboveHorizon(height, dot(up, view.sun.xyz), view.earth.x)) >= 1.0;
  bool may = wholeSun_ ? mayBeHidden(listed, toSun) : listed.z > 0.0;
  float towards = dot(normal, toSun) * inversesqrt(max(dot(normal, normal), 1.0e-30));
  sunlit_ = SUN_SHADED == 0 && !may && wholeSun_ && towards >= kSunlit;
  lightAndDepth_.x = towards > 0.0 ? towards : -1.0;  // turned away: nothing to tell one side from the other by
  return may;
}

int lightDemand(uvec2 id, vec2 pixel) {
  prepareRay(pixel);
  Draw draw = drawAt(id.x);
  vec3 d = inBody(draw, ray_), q = pointOnPlane(draw);
  Meeting m = meet(id.y, q, d);
  point_ = q + m.along * d;
  facet_ = m.geometric;
  toViewer_ = -d / rayLength_;
  triangle_ = id.y;
  sunlit_ = false;
  lightAndDepth_ = vec2(-1.0, 1.0 / max(planeOf(draw) + m.along, 1.0e-6));
  // The sun is the last of a row.
  vec3 normal = m.weight.x * texelFetch(vertices, m.corner.x + 1).xyz + m.weight.y * texelFetch(vertices, m.corner.y + 1).xyz +
                m.weight.z * texelFetch(vertices, m.corner.z + 1).xyz;
  if (dot(facet_, d) > 0.0) normal = -normal;
  int row = lightRow(draw), lamps = (LIGHTS > FEW_LIGHTS ? int(lightTexel(row).x) : LIGHTS) - SUN;
  bool hidden = SUN > 0 && sunMayBeHidden(lightEntry(row, lamps), normal, max((planeOf(draw) + m.along) * rayLength_, 1.0e-6));
  bool lit = hidden;
  smooth_ = !hidden;
  wholeSun_ = false;
  for (int k = 0; k < lamps; ++k) {
    int entry = lightEntry(row, k);
    vec4 listed = lightTexel(entry + 1);
    vec3 line = lightTexel(entry).xyz - point_;
    vec2 reach2 = lightTexel(entry + 2).xy;
    float d2 = dot(line, line), near2 = sunlit_ ? reach2.y : reach2.x;
    bool matters = listed.x >= 0.0 && d2 < near2;
    lit = lit || matters;
    if (SHADOWS_VARY > 0) {
      bool asked = LIGHTS <= FEW_LIGHTS && listed.z <= kFewCasters;
      bool stopped = asked ? mayBeHidden(asked ? listed : vec4(0.0), line * inversesqrt(max(d2, 1.0e-30))) : listed.z > 0.0;
      hidden = hidden || (matters && d2 < listed.w && stopped);
    }
    smooth_ = smooth_ && !(matters && d2 < kBends * near2);
  }
  return !lit ? kSunAlone : SHADOWS_VARY > 0 && !hidden ? kUnshadowed : kEveryLight;
}
