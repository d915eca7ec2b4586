// A few point lights and, as the last one where SUN is 1, the sun: each has its place in registers. Step 3 of the paper:
// E = I cos(theta_l) / d^2 tau; the air of both legs is passed as one length, because a band's transmittance does not multiply.
//@use sim/render/surface/glsl/lights_buffer.glsl
//@each l LIGHTS
//@each v COMPONENT_VECTORS
Vec3 lightFactor{l}_{v};  // irradiance per unit intensity x lobe of each component [1/m2]
//@end
AirPath lightAir{l}_;     // both legs
Vec3 toLight{l}_;
//@end

Vec3 toLight(int l) {
//@each l LIGHTS
  if (l == {l}) return toLight{l}_;
//@end
  return normal_;
}

void prepareLights() {
  prepareSunShade();
  lightCos_ = 0.0;
  lightDistance2_ = 1.0;
  int row = lightRow(draw_);
//@each l LIGHTS
  {
    LightHere here = lightAt(lightEntry(row, {l}), {l} >= LIGHTS - SUN);  // lights that don't matter have a place, and no strength
    toLight{l}_ = here.to;
//@each v COMPONENT_VECTORS
    lightFactor{l}_{v} = here.factor > 0.0 ? here.factor * lobes(here.to, {v}) : vec3(0.0);
//@end
    lightAir{l}_ = here.air;
  }
//@end
}

Real reflectedLight(int i) {
  Real sum = 0.0, own = 0.0;
//@each l LIGHTS
  own = 0.0;
//@each v COMPONENT_VECTORS
  own += dot(reflectionColumns(i, {l}, {v}), lightFactor{l}_{v});
//@end
  sum += own * nodes.nodeLight[i * LIGHT_GROUPS + {l} / 4][{l} % 4] * pathTransmittance(i, lightAir{l}_) * ({l} >= LIGHTS - SUN ? sunShade(i) : 1.0);
//@end
  return sum;
}
