//@use sim/radiometry/glsl/sun_disc.glsl
//@use sim/render/assembly/glsl/light_list.glsl

// Of a material's components three at a time: columns at a node for a light, and lobes.
Vec3 reflectionColumns(int i, int l, int v);
Vec3 lobes(Vec3 toLight, int v);
bool wholeSun_;  // it is the sun, and all of it above the point's horizon
//@slot shadow
//@slot sun_shade

// What the point sees of a light.
struct LightHere {
  vec3 to;       // unit
  float factor;  // irradiance per unit intensity [1/m2]; 0 behind the surface
  AirPath air;   // both legs
  int number;
};

//@slot light_patterns
LightHere lightAt(int entry, bool sun) {
  LightHere here;
  vec4 light = lightTexel(entry), listed = lightTexel(entry + 1);
  here.number = int(listed.x);
  vec3 line = sun ? light.xyz : light.xyz - point_;
  float share = 1.0;
  wholeSun_ = sun;
  if (SUN_SETS > 0 && sun) {  // the part of the sun's disc above the point's own horizon stands for the sun
    float x = sunAboveHorizon(height_, sunElevation_, view.earth.x), cosine = sqrt(max(1.0 - sunElevation_ * sunElevation_, 1.0e-6));
    float rise = sunRise(x) * sunRadius();
    share = sunShare(x);
    wholeSun_ = share >= 1.0;
    line = normalize(line + rise / cosine * up_);
    sunElevation_ += rise * cosine;
  }
  float d2 = sun ? 1.0 : dot(line, line);
  float d = sqrt(d2);
  here.to = d > 0.0 ? line / d : normal_;
  float cosLight = dot(normal_, here.to);
  if (here.number == 0 && !sun) {
    lightCos_ = cosLight;
    lightDistance2_ = d2;
  }
  here.factor = here.number < 0 ? 0.0 : isSurface_ * (sun ? share * max(cosLight, 0.0) : pointIrradianceFactor(cosLight, d2, light.w));
//@slot light_pattern
  if (here.factor > 0.0 && d2 < listed.w) here.factor *= shareSeen(listed, here.to, sun ? kFar : d - light.w);
  if (sun) here.air = airToSun(air_, height_);
  else here.air = airToLight(air_, height_, dot(up_, here.to), d);
  return here;
}
