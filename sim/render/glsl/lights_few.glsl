// A few point lights and, as the last one where SUN is 1, the sun: each has its place in registers. Step 3 of the paper:
// E = I cos(theta_l) / d^2 tau; the air of both legs is passed as one length, because a band's transmittance does not multiply.
//@use sim/render/glsl/lights_buffer.glsl
Vec3 lightFactor_[LIGHTS * COMPONENT_VECTORS];   // irradiance per unit intensity x lobe of each component [1/m2]
AirPath lightAir_[LIGHTS];   // both legs
Vec3 toLight_[LIGHTS];

Vec3 toLight(int l) { return toLight_[l]; }

void prepareLights() {
  lightCos_ = 0.0;
  lightDistance2_ = 1.0;
  int row = int(draw_.state.z) * (2 * LIGHTS + 1);
  for (int l = 0; l < LIGHTS; ++l) {
    LightHere here = lightAt(row + 2 * l + 1);  // lights that don't matter have a place, and no strength
    toLight_[l] = here.to;
    for (int v = 0; v < COMPONENT_VECTORS; ++v)
      lightFactor_[l * COMPONENT_VECTORS + v] = here.factor > 0.0 ? here.factor * lobes(here.to, v) : vec3(0.0);
    lightAir_[l] = here.air;
  }
}

// Without the loop where one vector holds all components: it keeps drivers from unrolling the loop over nodes.
Real reflectedOf(int i, int l) {
  if (COMPONENT_VECTORS == 1) return dot(reflectionColumns(i, l, 0), lightFactor_[l]);
  Real sum = 0.0;
  for (int v = 0; v < COMPONENT_VECTORS; ++v) sum += dot(reflectionColumns(i, l, v), lightFactor_[l * COMPONENT_VECTORS + v]);
  return sum;
}

Real reflectedLight(int i) {
  Real sum = 0.0;
  for (int l = 0; l < LIGHTS; ++l)
    sum += reflectedOf(i, l) * nodes.nodeLight[i * LIGHT_GROUPS + l / 4][l % 4] * pathTransmittance(i, lightAir_[l]);
  return sum;
}
