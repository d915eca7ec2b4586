// Materials with tables over angles, modifier textures or temperature textures: components are put together per fragment.
//@use sim/render/glsl/materials.glsl
//@use sim/render/glsl/textures.glsl
layout(std430, binding = 3) readonly buffer Rows { float rows[]; };                  // Planck radiance per temperature and node
layout(std430, binding = 4) readonly buffer Hemispherical { vec4 hemispherical[]; };  // (D1, D2, D3, given emissivity) by view angle and node
layout(std430, binding = 7) readonly buffer Columns { vec4 columns[]; };              // (R1, R2, R3) by angle 2, angle 1 and node
MaterialShape material_;
vec4 modifier_;
uint view0_, view1_;
float viewMix_;
float temperature_;

// Arc tangent of t >= 0 to single precision; GLSL's own is allowed 4096 units of the last place (Mesa's asin is off by 3e-4).
// Source: S. Moshier, Cephes atanf: reduction at tan(pi/8) and tan(3 pi/8), odd polynomial.
float arcTangent(float t) {
  float base = t > 2.414213562 ? 1.570796327 : t > 0.414213562 ? 0.785398163 : 0.0;
  float x = t > 2.414213562 ? -1.0 / t : t > 0.414213562 ? (t - 1.0) / (t + 1.0) : t;
  float z = x * x;
  return base + (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1) * z * x + x;
}

// The angle between unit vectors from chord and sum: keeps its digits near 0 and near pi.
float angleFromChord(vec3 a, vec3 b) { return 2.0 * arcTangent(length(a - b) / max(length(a + b), 1.0e-20)); }

float angleOf(uint kind, Vec3 l) {
  if (kind == 1u) return angleFromChord(normal_, l);
  if (kind == 2u) return angleFromChord(normal_, toViewer_);
  if (kind == 3u) return angleFromChord(reflect(-l, normal_), toViewer_);
  if (kind == 4u) return angleFromChord(normal_, normalize(l + toViewer_));
  if (kind == 5u) return angleFromChord(l, normalize(l + toViewer_));
  return 0.0;
}

float modifierAt(int texture) { return texture < 0 ? 1.0 : textureValue(texture, uv_); }

void prepareSurface() {
  material_ = materials[draw_.table.y];
  exponents_ = material_.exponent.xyz;
  modifier_ = vec4(modifierAt(material_.modifier.x), modifierAt(material_.modifier.y), modifierAt(material_.modifier.z), modifierAt(material_.modifier.w));
  viewMix_ = clamp(angleFromChord(normal_, toViewer_) * material_.scale.z, 0.0, float(material_.counts.z - 1u));
  uint j = min(uint(viewMix_), max(material_.counts.z, 2u) - 2u);
  viewMix_ -= float(j);
  view0_ = material_.kinds.w + j * uint(NODES);
  view1_ = material_.counts.z > 1u ? view0_ + uint(NODES) : view0_;
  temperature_ = draw_.table.z > 0u ? textureValue(int(draw_.table.z) - 1, uv_) : draw_.state.x;
}

Vec3 reflectionColumns(int i, int l) {
  float x = 0.0, y = 0.0;
  if (material_.kinds.x != 0u) x = clamp(angleOf(material_.kinds.x, toLight(l)) * material_.scale.x, 0.0, float(material_.counts.x - 1u));
  if (material_.kinds.y != 0u) y = clamp(angleOf(material_.kinds.y, toLight(l)) * material_.scale.y, 0.0, float(material_.counts.y - 1u));
  uint jx = min(uint(x), max(material_.counts.x, 2u) - 2u), jy = min(uint(y), max(material_.counts.y, 2u) - 2u);
  float fx = x - float(jx), fy = y - float(jy);
  uint sx = material_.counts.x > 1u ? uint(NODES) : 0u;
  uint sy = material_.counts.y > 1u ? material_.counts.x * uint(NODES) : 0u;
  uint at = material_.counts.w + (jy * material_.counts.x + jx) * uint(NODES) + uint(i);
  vec3 low = mix(columns[at].xyz, columns[at + sx].xyz, fx);
  vec3 high = mix(columns[at + sy].xyz, columns[at + sx + sy].xyz, fx);
  return mix(low, high, fy) * modifier_.xyz;
}

//@slot temperature

Real selfRadiance(int i) {
  vec4 d = mix(hemispherical[view0_ + uint(i)], hemispherical[view1_ + uint(i)], viewMix_);
  float reflectance = dot(d.xyz, modifier_.xyz);
  float emissivity = material_.kinds.z == 1u ? 1.0 - reflectance : d.w * modifier_.w;
  return isSurface_ * reflectance * nodes.nodeAmbient[i].x + emissivity * sourceRadiance(i);
}
float truthTemperature() { return temperature_; }
