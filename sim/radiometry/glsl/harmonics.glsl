// Real spherical harmonics of degrees 1 to 4 at a unit vector, in the order m = -l .. l: sim/radiometry/harmonics.hpp.
struct Harmonics4 {
  vec3 one;
  vec4 two;
  float two4;
  vec3 three;
  vec4 three3;
  vec4 four, four4;
  float four8;
};
Harmonics4 harmonicsAt(vec3 d) {
  float x = d.x, y = d.y, z = d.z, x2 = x * x, y2 = y * y, z2 = z * z;
  Harmonics4 h;
  h.one = 0.48860251 * vec3(y, z, x);
  h.two = vec4(1.09254843 * x * y, 1.09254843 * y * z, 0.31539157 * (3.0 * z2 - 1.0), 1.09254843 * x * z);
  h.two4 = 0.54627422 * (x2 - y2);
  h.three = vec3(0.59004359 * y * (3.0 * x2 - y2), 2.89061144 * x * y * z, 0.45704580 * y * (5.0 * z2 - 1.0));
  h.three3 = vec4(0.37317633 * z * (5.0 * z2 - 3.0), 0.45704580 * x * (5.0 * z2 - 1.0), 1.44530572 * z * (x2 - y2), 0.59004359 * x * (x2 - 3.0 * y2));
  h.four = vec4(2.50334294 * x * y * (x2 - y2), 1.77013077 * y * z * (3.0 * x2 - y2), 0.94617470 * x * y * (7.0 * z2 - 1.0),
                0.66904654 * y * z * (7.0 * z2 - 3.0));
  h.four4 = vec4(0.10578555 * (z2 * (35.0 * z2 - 30.0) + 3.0), 0.66904654 * x * z * (7.0 * z2 - 3.0), 0.47308735 * (x2 - y2) * (7.0 * z2 - 1.0),
                 1.77013077 * x * z * (x2 - 3.0 * y2));
  h.four8 = 0.62583574 * (x2 * (x2 - 6.0 * y2) + y2 * y2);
  return h;
}

// Coefficients of a light, l l + l + m from 0 on, four to a vec4.
struct LightHarmonics {
  vec4 first, second, third, fourth, fifth, sixth;
  float last;
};
float ofDegree1(LightHarmonics light, Harmonics4 h) { return dot(light.first.yzw, h.one); }
float ofDegree2(LightHarmonics light, Harmonics4 h) { return dot(light.second, h.two) + light.third.x * h.two4; }
float ofDegree3(LightHarmonics light, Harmonics4 h) { return dot(light.third.yzw, h.three) + dot(light.fourth, h.three3); }
float ofDegree4(LightHarmonics light, Harmonics4 h) { return dot(light.fifth, h.four) + dot(light.sixth, h.four4) + light.last * h.four8; }
