// Materials with tables over angles, modifier textures or temperature textures: components are put together per fragment.
//@use sim/render/assembly/glsl/materials.glsl
//@use sim/radiometry/glsl/arc_tangent.glsl
layout(binding = 2) uniform samplerBuffer hemispherical;  // (D1, D2, D3, emissivity of modifiers of 1), (D4 ... by view angle and node
MaterialShape material_;
vec3 modifier_[COMPONENT_VECTORS];  // of the components
float emissionModifier_;
int view0_, view1_, viewEntry_;
float transmissionModifier_;
float viewMix_;
int state_;  // the entry below the state of the surface
float stateMix_;
float temperature_;

// The angle between unit vectors from chord and sum: keeps its digits near 0 and near pi.
float angleFromChord(vec3 a, vec3 b) { return 2.0 * arcTangent(length(a - b) / max(length(a + b), 1.0e-20)); }

//@slot modifiers

// So many entries on, from one state to the next, in a table of so many for each.
int nextState(int each) { return material_.state.y > 1 ? each : 0; }

float surfaceTemperature();
void prepareTemperature();
void prepareAmbient();

void prepareSurface() {
  material_ = materialAt(draw_.table.y);
  float last = 1.0;
  for (int v = 0; v < COMPONENT_VECTORS; ++v)
    for (int k = 0; k < 3; ++k) modifier_[v][k] = last = 3 * v + k < USED_COMPONENTS ? modifierOf(3 * v + k, last) : 1.0;
  emissionModifier_ = EMISSION_MODIFIERS > 0 ? modifierAt(material_.transmission.z) : 1.0;
  temperature_ = surfaceTemperature();
  state_ = 0;
  stateMix_ = 0.0;
  if (STATES > 0 && material_.state.y > 1) {
    float drives = material_.state.x >= 0 ? modifierAt(material_.state.x) : temperature_;
    stateMix_ = clamp((drives - material_.stateScale.x) * material_.stateScale.y, 0.0, float(material_.state.y - 1));
    state_ = min(int(stateMix_), material_.state.y - 2);
    stateMix_ -= float(state_);
  }
  viewMix_ = VIEW_ANGLES > 0 ? clamp(angleFromChord(normal_, toViewer_) * material_.scale.z, 0.0, float(material_.counts.z - 1u)) : 0.0;
  int j = int(min(uint(viewMix_), max(material_.counts.z, 2u) - 2u));
  viewMix_ -= float(j);
  viewEntry_ = j;
  transmissionModifier_ = TRANSMISSION_MODIFIERS > 0 ? modifierAt(material_.transmission.x) : 1.0;
  view0_ = int(material_.kinds.w) + (state_ * int(material_.counts.z) + j) * NODES * COMPONENT_VECTORS;
  view1_ = material_.counts.z > 1u ? view0_ + NODES * COMPONENT_VECTORS : view0_;
  prepareTemperature();
  prepareAmbient();
}

// (D1, D2, D3, given emissivity) or what follows it.
vec4 hemisphericalByView(int at) {
  vec4 first = texelFetch(hemispherical, view0_ + at);
  return VIEW_ANGLES > 0 ? mix(first, texelFetch(hemispherical, view1_ + at), viewMix_) : first;
}
vec4 hemisphericalAt(int at) {
  vec4 d = hemisphericalByView(at);
  return STATES == 0 ? d : mix(d, hemisphericalByView(at + nextState(int(material_.counts.z) * NODES * COMPONENT_VECTORS)), stateMix_);
}

//@slot columns

//@slot temperature

//@slot transmission

//@slot ambient

Real selfRadiance(int i) {
  vec4 d = hemisphericalAt(i * COMPONENT_VECTORS);
  float reflectance = dot(d.xyz, modifier_[0]), lost = dot(d.xyz, 1.0 - modifier_[0]), given = d.w;
  if (COMPONENT_VECTORS > 1)
    for (int v = 1; v < COMPONENT_VECTORS; ++v) {
      vec3 more = hemisphericalAt(i * COMPONENT_VECTORS + v).xyz;
      reflectance += dot(more, modifier_[v]);
      lost += dot(more, 1.0 - modifier_[v]);
    }
  float emissivity = material_.kinds.z == 1u ? given + lost + transmittanceLost(i) : given * emissionModifier_;
  return reflectedAmbient(reflectance, i) + emissivity * sourceRadiance(i);
}
float truthTemperature() { return temperature_; }
