// Many point lights and, as the last one where SUN is 1, the sun; see lights_few.glsl. A body's row lists those that can matter to it; of
// them a point keeps the ones that shine on its face.
//@use sim/render/surface/glsl/lights_buffer.glsl
Vec3 lightFactor_[LIGHT_PLACES * COMPONENT_VECTORS];   // irradiance per unit intensity x lobe of each component [1/m2]
AirPath lightAir_[LIGHT_PLACES];   // both legs
Vec3 toLight_[LIGHT_PLACES];
int lightNumber_[LIGHT_PLACES];
int shining_;

Vec3 toLight(int l) { return toLight_[l]; }

void prepareLights() {
  prepareSunShade();
  lightCos_ = 0.0;
  lightDistance2_ = 1.0;
  shining_ = 0;
  int row = lightRow(draw_);
  int count = int(lightTexel(row).x);
  for (int k = 0; k < count; ++k) {
    LightHere here = lightAt(lightEntry(row, k), int(lightTexel(lightEntry(row, k) + 1).x) >= LIGHTS - SUN);
    if (!(here.factor > 0.0)) continue;
    toLight_[shining_] = here.to;
    for (int v = 0; v < COMPONENT_VECTORS; ++v) lightFactor_[shining_ * COMPONENT_VECTORS + v] = here.factor * lobes(here.to, v);
    lightAir_[shining_] = here.air;
    lightNumber_[shining_] = here.number;
    ++shining_;
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
  for (int l = 0; l < shining_; ++l) {
    int number = lightNumber_[l];
    Real shade = number >= LIGHTS - SUN ? sunShade(i) : 1.0;
    sum += shade * reflectedOf(i, l) * nodes.nodeLight[i * LIGHT_GROUPS + number / 4][number % 4] * pathTransmittance(i, lightAir_[l]);
  }
  return sum;
}
