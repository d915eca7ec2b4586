// Arc tangent of t >= 0 to single precision; GLSL's own is allowed 4096 units of the last place (Mesa's asin is off by 3e-4).
// Source: S. Moshier, Cephes atanf: reduction at tan(pi/8) and tan(3 pi/8), odd polynomial.
PHYSICS Real arcTangent(Real t) {
  Real base = t > 2.414213562 ? 1.5707963267948966 : t > 0.414213562 ? 0.78539816339744831 : 0.0;
  Real x = t > 2.414213562 ? -1.0 / t : t > 0.414213562 ? (t - 1.0) / (t + 1.0) : t;
  Real z = x * x;
  return base + (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1) * z * x + x;
}
