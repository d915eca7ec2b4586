// Where no lamp matters and nothing stands before the sun (light_demand.glsl): the sun alone, of which the point sees all. See lights_few.glsl.
//@use sim/render/surface/glsl/lights_buffer.glsl
//@each v COMPONENT_VECTORS
Vec3 lightFactor_{v};
//@end
AirPath lightAir_;
Vec3 toLight_;

Vec3 toLight(int l) { return toLight_; }

void prepareLights() {
  prepareSunShade();
  int row = lightRow(draw_), last = LIGHTS > FEW_LIGHTS ? int(lightTexel(row).x) - 1 : LIGHTS - 1;
  lightCos_ = 0.0;
  lightDistance2_ = 1.0;
  if (LIGHTS > SUN && int(lightTexel(lightEntry(row, 0) + 1).x) == 0) {  // of the first lamp, for truth
    vec3 line = lightTexel(lightEntry(row, 0)).xyz - point_;
    lightDistance2_ = dot(line, line);
    lightCos_ = dot(normal_, line) * inversesqrt(max(lightDistance2_, 1.0e-30));
  }
  LightHere here = lightAt(lightEntry(row, last), true);
  toLight_ = here.to;
//@each v COMPONENT_VECTORS
  lightFactor_{v} = here.factor > 0.0 ? here.factor * lobes(here.to, {v}) : vec3(0.0);
//@end
  lightAir_ = here.air;
}

Real reflectedLight(int i) {
  Real own = 0.0;
//@each v COMPONENT_VECTORS
  own += dot(reflectionColumns(i, LIGHTS - 1, {v}), lightFactor_{v});
//@end
  return own * nodes.nodeLight[i * LIGHT_GROUPS + (LIGHTS - 1) / 4][(LIGHTS - 1) % 4] * pathTransmittance(i, lightAir_) * sunShade(i);
}
