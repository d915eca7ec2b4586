// Point lights and, as the last one where SUN is 1, the sun. Step 3 of the paper: E = I cos(theta_l) / d^2 tau; the air of both
// legs is passed as one length, because a band's transmittance does not multiply.
// A body's row lists the lights that can matter to it; of those, a point keeps the ones that shine on its face.
layout(std430, binding = 5) readonly buffer Lights { vec4 lights[]; };  // per row: (count); per light: position or direction in the body frame, radius; (number)
Vec3 lightFactor_[LIGHTS];   // irradiance per unit intensity x lobe of each component [1/m2]
float lightAir_[LIGHTS];     // both legs [m]
Vec3 toLight_[LIGHTS];
int lightNumber_[LIGHTS];
int shining_;

Vec3 reflectionColumns(int i, int l);
Vec3 lobes(Vec3 toLight);

Vec3 toLight(int l) { return toLight_[l]; }

void prepareLights() {
  lightCos_ = 0.0;
  lightDistance2_ = 1.0;
  shining_ = 0;
  int row = int(draw_.state.z) * (2 * LIGHTS + 1);
  int count = int(lights[row].x);
  for (int k = 0; k < count; ++k) {
    vec4 light = lights[row + 2 * k + 1];
    int number = int(lights[row + 2 * k + 2].x);
    bool sun = number >= LIGHTS - SUN;
    vec3 line = sun ? light.xyz : light.xyz - point_;
    float d2 = sun ? 1.0 : dot(line, line);
    float d = sqrt(d2);
    vec3 to = d > 0.0 ? line / d : normal_;
    float cosLight = dot(normal_, to);
    if (number == 0 && !sun) {
      lightCos_ = cosLight;
      lightDistance2_ = d2;
    }
    float factor = isSurface_ * (sun ? max(cosLight, 0.0) : pointIrradianceFactor(cosLight, d2, light.w));
    if (!(factor > 0.0)) continue;
    float leg = sun ? sunAirLength(height_) : airLength(height_, dot(up_, to), d);
    toLight_[shining_] = to;
    lightFactor_[shining_] = factor * lobes(to);
    lightAir_[shining_] = airLength_ + leg;
    lightNumber_[shining_] = number;
    ++shining_;
  }
}

Real reflectedLight(int i) {
  Real sum = 0.0;
  for (int l = 0; l < shining_; ++l) {
    int number = lightNumber_[l];
    sum += dot(reflectionColumns(i, l), lightFactor_[l]) * nodes.nodeLight[i * LIGHT_GROUPS + number / 4][number % 4] * pathTransmittance(i, lightAir_[l]);
  }
  return sum;
}
