// A puff: a soft ellipsoid of gas, round or drawn out along an axis. Shared by GLSL (float) and C++ (double).
//   density = (C M/(R^2 L)) (1 - s^2)^3 for s < 1, 0 beyond; C = 315/(64 pi): its integral is M. s: distance from the centre in units of the support, of radius
//   is R across the axis and L along it. Density, slope and curvature are 0 at the edge. The kernel is a spline's, near to a Gaussian of sigma = R/sqrt(11).
// A line p + t d, in units of the support (puffScaled), has 1 - s^2 = depth - a (t - middle)^2, so that with u = (t - middle)/reach a stretch's integral of
// (1 - s^2)^3 over t is  reach depth^3 int (1 - u^2)^3 du.

// Part of a vector in units of the support: R across, L along the unit axis; squash = R/L - 1.
PHYSICS Vec3 puffScaled(Vec3 v, Vec3 axis, Real squash, Real radius) { return (v + (squash * dot(v, axis)) * axis) / radius; }

// Middle and half-length of its chord in t, and 1 - s^2 at the middle; half-length 0: it misses. The foot of the centre on the line keeps the digits of a
// puff that is far from where t = 0.
PHYSICS Vec3 puffChord(Vec3 point, Vec3 direction) {
  Real a = dot(direction, direction);
  Real middle = -dot(point, direction) / a;
  Vec3 foot = point + middle * direction;
  Real depth = 1.0 - dot(foot, foot);
  return depth > 0.0 ? Vec3(middle, sqrt(depth / a), depth) : Vec3(middle, 0.0, 0.0);
}

PHYSICS Real puffKernel(Real u) {
  Real f = (1.0 - u) * (1.0 + u);
  return f * f * f;
}

// Integral of (1 - s^2)^3 over t between two t's, within its chord. A polynomial of degree 6: four Gauss points are exact, and have no differences of nearly
// equal numbers.
PHYSICS Real puffColumn(Vec3 chord, Real from, Real to) {
  if (chord.y <= 0.0) return 0.0;
  Real low = max((from - chord.x) / chord.y, -1.0);
  Real high = min((to - chord.x) / chord.y, 1.0);
  if (high <= low) return 0.0;
  Real half_ = 0.5 * (high - low);
  Real middle = 0.5 * (high + low);
  Real outer = 0.861136311594052575 * half_;
  Real inner = 0.339981043584856265 * half_;
  Real sum = 0.347854845137453857 * (puffKernel(middle - outer) + puffKernel(middle + outer)) +
             0.652145154862546143 * (puffKernel(middle - inner) + puffKernel(middle + inner));
  return chord.y * chord.z * chord.z * chord.z * half_ * sum;
}
