// Where a line crosses a body, in body coordinates: point + t direction for t in (x, y) of the result; y <= x: it misses. Shared by GLSL
// (float) and C++ (double). Lengths come from differences of t at the body, never from ranges, so that a far body's chord keeps its
// digits; the caller takes the point near the body.

// Ellipsoid with semi-axes along the body's, centred on the origin.
//   |(p + t d) / s| = 1 from the point of closest approach m:  t = t_m +- sqrt((1 - |m|^2) / |d/s|^2).
PHYSICS Vec2 ellipsoidChord(Vec3 point, Vec3 direction, Vec3 semiAxes) {
  Vec3 p = point / semiAxes;
  Vec3 d = direction / semiAxes;
  Real a = dot(d, d);
  Real middle = -dot(p, d) / a;
  Vec3 m = p + middle * d;
  Real h = sqrt(dot(m, m));
  if (h >= 1.0) return Vec2(0.0, 0.0);
  Real reach = sqrt((1.0 - h) * (1.0 + h) / a);
  return Vec2(middle - reach, middle + reach);
}

// Cone, frustum or cylinder along x, centred on the origin, with flat ends: base radius at -halfLength, top radius at +halfLength.
//   Inside: |x| <= h and y^2 + z^2 <= r(x)^2, r(x) = r0 + k x: a quadratic a t^2 + 2 b t + c <= 0 between the planes of the ends. Where
//   a < 0 the line runs inside both nappes of the whole cone, and the one with r > 0 counts. Roots in the form that does not cancel.
PHYSICS Vec2 coneChord(Vec3 point, Vec3 direction, Real halfLength, Real baseRadius, Real topRadius) {
  Real enter = -kFar;
  Real leave = kFar;
  if (direction.x != 0.0) {
    Real t1 = (-halfLength - point.x) / direction.x;
    Real t2 = (halfLength - point.x) / direction.x;
    enter = min(t1, t2);
    leave = max(t1, t2);
  } else if (point.x < -halfLength || point.x > halfLength) {
    return Vec2(0.0, 0.0);
  }
  Real slope = 0.5 * (topRadius - baseRadius) / halfLength;
  Real r = 0.5 * (topRadius + baseRadius) + slope * point.x;
  Real widening = slope * direction.x;
  Real a = direction.y * direction.y + direction.z * direction.z - widening * widening;
  Real b = point.y * direction.y + point.z * direction.z - r * widening;
  Real c = point.y * point.y + point.z * point.z - r * r;
  Real root = b * b - a * c;
  // Inside, and no crossing within any distance: parallel to the side of a cylinder.
  if (root <= 0.0 && a >= 0.0) return c < 0.0 ? Vec2(enter, max(enter, leave)) : Vec2(0.0, 0.0);
  root = sqrt(max(root, 0.0));  // inside both nappes it passes the tip at worst: what is below 0 is rounding
  Real q = b >= 0.0 ? -b - root : -b + root;
  Real other = q != 0.0 ? c / q : 0.0;
  // Nearly parallel to the side: its far crossing lies beyond any body.
  Real one = a > 1.0e-30 || a < -1.0e-30 ? q / a : ((q > 0.0) == (a >= 0.0) ? kFar : -kFar);
  Real near = min(one, other);
  Real far = max(one, other);
  if (a >= 0.0) {
    enter = max(enter, near);
    leave = min(leave, far);
  } else if (widening > 0.0) {
    enter = max(enter, far);
  } else {
    leave = min(leave, near);
  }
  return Vec2(enter, max(enter, leave));
}
