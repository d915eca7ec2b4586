//@use sim/radiometry/glsl/exponential.glsl
// The law of a segment of path: what matter on it sends towards the eye, and the sunlight that it turns there. Shared by GLSL (float) and C++ (double).
//   L = integral of J(t) exp(-t) dt from 0 to d = J_near (1 - exp(-d)) + (J_far - J_near) g(d),   g(d) = (1 - exp(-d) (1 + d)) / d
//   t optical depth from the near end, d that of the segment; J source radiance [W/(m2 sr um)], linear in t: J_near, J_far at its ends.
//   Thick: J_near; thin: d times the mean of both. Of several kinds of matter J is the mean by their depths.
// Source: Chandrasekhar 1960, Radiative Transfer, chapter I (the formal solution); phase functions: chapter III, and Henyey and Greenstein 1941.
// Valid: d >= 0.

// (1 - exp(-x)) / x for x >= 0: mean transmittance along a path of optical depth x; 1 at 0.
PHYSICS Real meanDecay(Real x) { return x > 1.0e-30 ? oneMinusExp(x) / x : 1.0; }

// The same where left = exp(-x) is known.
PHYSICS Real meanDecayOf(Real x, Real left) {
  Real series = meanDecaySeries(x);
  return x < 0.125 ? series : (1.0 - left) / x;
}

// g(d), of which left = exp(-d) and lost = 1 - exp(-d) are known.
//   Below 0.125: series, the sum of n (-d)^(n-1) d / (n + 1)! to d^9, truncation 2 d^9 / 3991680 < 4e-15 relative. Above: the plain difference, which loses
//   a factor of 2 / d^2 of its digits at most.
PHYSICS Real growthOf(Real d, Real left, Real lost) {
  Real series = d * (1.0 / 2.0 - d * (1.0 / 3.0 - d * (1.0 / 8.0 - d * (1.0 / 30.0 - d * (1.0 / 144.0 - d * (1.0 / 840.0 -
                d * (1.0 / 5760.0 - d * (1.0 / 45360.0 - d * (1.0 / 403200.0)))))))));
  return d < 0.125 ? series : (lost - d * left) / d;
}

// L of the law above.
PHYSICS Real segmentRadiance(Real near, Real far, Real d, Real left, Real lost) { return near * lost + (far - near) * growthOf(d, left, lost); }

// The same by the source in the middle and by what it changes by from the near end to the far one.
PHYSICS Real driftingRadiance(Real middle, Real change, Real d, Real left, Real lost) {
  return middle * lost + (change != 0.0 ? change * (growthOf(d, left, lost) - 0.5 * lost) : 0.0);
}

// Mean of exp(-D) over a segment, D linear between the depths at its ends, of which the exponentials are known. Times the segment's depth of scattering, the
// phase function and the irradiance it is the sunlight that the segment turns to the eye: D from the eye to a place and on to the sun.
PHYSICS Real meanPassed(Real from, Real to, Real fromPassed, Real toPassed) {
  Real change = to - from;
  return abs(change) < 0.125 ? fromPassed * meanDecaySeries(change) : (fromPassed - toPassed) / change;
}

// The same where they are not known. The lesser depth comes out of the mean, so that neither overflows: looking up from shade, the way to the sun gets shorter
// by thousands.
PHYSICS Real meanPassedBetween(Real from, Real to) { return exp(-min(from, to)) * meanDecay(abs(to - from)); }

// Phase functions [1/sr] of the angle between the light's way and the way on; their integral over the sphere is 1. Molecules; particles of an asymmetry g, the
// mean cosine, -0.99 to 0.99 (single precision keeps three digits of the sharpest).
PHYSICS Real rayleighPhase(Real cosScatter) { return 3.0 / (16.0 * 3.14159265358979323846) * (1.0 + cosScatter * cosScatter); }
PHYSICS Real henyeyGreensteinPhase(Real cosScatter, Real g) {
  Real chord = 1.0 + g * g - 2.0 * g * cosScatter;
  return (1.0 - g * g) / (4.0 * 3.14159265358979323846 * chord * sqrt(chord));
}
