// Point lights and, as the last one where SUN is 1, the sun. Step 3 of the paper: E = I cos(theta_l) / d^2 tau; the air of both
// legs is passed as one length, because a band's transmittance does not multiply.
layout(std430, binding = 5) readonly buffer Lights { vec4 lights[]; };  // per draw and light: position or direction in the body frame, radius
Vec3 lightFactor_[LIGHTS];   // irradiance per unit intensity x lobe of each component [1/m2]
float lightAir_[LIGHTS];     // both legs [m]
Vec3 toLight_[LIGHTS];

Vec3 reflectionColumns(int i, int l);
Vec3 lobes(Vec3 toLight);

Vec3 toLight(int l) { return toLight_[l]; }

void prepareLights() {
  lightCos_ = 0.0;
  lightDistance2_ = 1.0;
  int row = int(draw_.state.z) * LIGHTS;
  for (int l = 0; l < LIGHTS; ++l) {
    vec4 light = lights[row + l];
    bool sun = l >= LIGHTS - SUN;
    vec3 line = sun ? light.xyz : light.xyz - point_;
    float d2 = sun ? 1.0 : dot(line, line);
    float d = sqrt(d2);
    toLight_[l] = d > 0.0 ? line / d : normal_;
    float cosLight = dot(normal_, toLight_[l]);
    if (l == 0 && !sun) {
      lightCos_ = cosLight;
      lightDistance2_ = d2;
    }
    float factor = isSurface_ * (sun ? max(cosLight, 0.0) : pointIrradianceFactor(cosLight, d2, light.w));
    lightFactor_[l] = factor > 0.0 ? factor * lobes(toLight_[l]) : vec3(0.0);
    float leg = sun ? sunAirLength(height_) : airLength(height_, dot(up_, toLight_[l]), d);
    lightAir_[l] = airLength_ + leg;
  }
}

Real reflectedLight(int i) {
  Real sum = 0.0;
  for (int l = 0; l < LIGHTS; ++l)
    sum += dot(reflectionColumns(i, l), lightFactor_[l]) * nodes.nodeLight[i * LIGHT_GROUPS + l / 4][l % 4] * pathTransmittance(i, lightAir_[l]);
  return sum;
}
