// Exponentials that keep their digits at both ends. Shared by GLSL (float) and C++ (double).

// (1 - exp(-x)) / x for |x| < 0.125: Taylor series to x^7, truncation x^8/9! < 2e-13 relative.
PHYSICS Real meanDecaySeries(Real x) {
  return 1.0 - x * (1.0 / 2.0) * (1.0 - x * (1.0 / 3.0) * (1.0 - x * (1.0 / 4.0) * (1.0 - x * (1.0 / 5.0) *
         (1.0 - x * (1.0 / 6.0) * (1.0 - x * (1.0 / 7.0) * (1.0 - x * (1.0 / 8.0)))))));
}

// 1 - exp(-x) for x >= 0, without cancellation: below 0.125 by the series, above by the plain difference, which loses at most 3 bits
// (1 - exp(-0.125) = 0.118). x may be infinite (1).
PHYSICS Real oneMinusExp(Real x) {
  Real series = x * meanDecaySeries(x);
  return x < 0.125 ? series : 1.0 - exp(-x);
}

// The same where left = exp(-x) is known.
PHYSICS Real lostOf(Real x, Real left) {
  Real series = x * meanDecaySeries(x);
  return x < 0.125 ? series : 1.0 - left;
}

// exp(-x) for x >= 0 with a two-part reduction, so that the error does not grow with x (exp2 hardware rounds x log2(e)).
//   ln 2 = 0.693145751953125 (exact in 16 bits) + 1.42860682030941723e-6. Beyond kExpLimit: 0 (the result is not a normal number).
PHYSICS Real decay(Real x) {
  if (x > kExpLimit) return 0.0;
  Real k = floor(x * 1.44269504088896341 + 0.5);
  Real r = (x - k * 0.693145751953125) - k * 1.42860682030941723e-6;
  return ldexp(exp(-r), -int(k));
}

// ln(1 - c) for 0 <= c < 1. Below 0.05 by series (truncation c^12/13 < 2e-17 relative).
PHYSICS Real logOneMinus(Real c) {
  if (c >= 0.05) return log(1.0 - c);
  Real sum = 0.0;
  for (int k = 12; k >= 1; --k) sum = sum * c + 1.0 / Real(k);
  return -c * sum;
}
