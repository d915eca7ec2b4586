// Materials with tables over angles, modifier textures or temperature textures: components are put together per fragment.
//@use sim/render/glsl/materials.glsl
//@use sim/radiometry/glsl/arc_tangent.glsl
layout(binding = 1) uniform samplerBuffer rows;           // Planck radiance per temperature and node
layout(binding = 2) uniform samplerBuffer hemispherical;  // (D1, D2, D3, emissivity of modifiers of 1) by view angle and node
MaterialShape material_;
vec4 modifier_;
int view0_, view1_, viewEntry_;
float transmissionModifier_;
float viewMix_;
float temperature_;

// The angle between unit vectors from chord and sum: keeps its digits near 0 and near pi.
float angleFromChord(vec3 a, vec3 b) { return 2.0 * arcTangent(length(a - b) / max(length(a + b), 1.0e-20)); }

//@slot modifiers

void prepareLobes();
float surfaceTemperature();
void prepareTemperature();

void prepareSurface() {
  material_ = materials[draw_.table.y];
  prepareLobes();
  modifier_ = vec4(modifierAt(material_.modifier.x), modifierAt(material_.modifier.y), modifierAt(material_.modifier.z), modifierAt(material_.modifier.w));
  viewMix_ = clamp(angleFromChord(normal_, toViewer_) * material_.scale.z, 0.0, float(material_.counts.z - 1u));
  int j = int(min(uint(viewMix_), max(material_.counts.z, 2u) - 2u));
  viewMix_ -= float(j);
  viewEntry_ = j;
  transmissionModifier_ = modifierAt(material_.transmission.x);
  view0_ = int(material_.kinds.w) + j * NODES;
  view1_ = material_.counts.z > 1u ? view0_ + NODES : view0_;
  temperature_ = surfaceTemperature();
  prepareTemperature();
}

//@slot columns

//@slot temperature

//@slot transmission

//@slot ambient

Real selfRadiance(int i) {
  vec4 d = mix(texelFetch(hemispherical, view0_ + i), texelFetch(hemispherical, view1_ + i), viewMix_);
  float reflectance = dot(d.xyz, modifier_.xyz);
  float emissivity = material_.kinds.z == 1u ? d.w + dot(d.xyz, 1.0 - modifier_.xyz) + transmittanceLost(i) : d.w * modifier_.w;
  return reflectedAmbient(reflectance, i) + emissivity * sourceRadiance(i);
}
float truthTemperature() { return temperature_; }
