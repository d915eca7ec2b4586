// What a pixel covers of a texture. Shared by GLSL (float) and C++ (double).

// How far texture coordinates move on a triangle when a ray turns by a step: P = depth ray lies on the triangle's plane, so that
//   dP = depth (step - ray (n . step) / (n . ray)),   duv = (dP x e2 . n uv1 + e1 x dP . n uv2) / n^2,   n = e1 x e2.
// step, ray: of the same frame and scale; depth: of the point in lengths of the ray; uv1, uv2: of the corners at e1, e2, less the first's.
// Source: Igehy 1999, Tracing Ray Differentials, section 3.1. Where the plane is seen edge on a step is as long as at 1e-4 rad.
PHYSICS Vec2 uvStep(Vec3 step, Vec3 ray, Real depth, Vec3 normal, Vec3 e1, Vec3 e2, Vec2 uv1, Vec2 uv2) {
  Real n2 = dot(normal, normal), facing = dot(normal, ray), least = 1.0e-4 * sqrt(n2 * dot(ray, ray));
  Real held = facing < 0.0 ? min(facing, -least) : max(facing, least);
  if (n2 <= 0.0) return Vec2(0.0, 0.0);
  Vec3 moved = depth * (step - ray * (dot(normal, step) / held));
  return (dot(cross(moved, e2), normal) * uv1 + dot(cross(e1, moved), normal) * uv2) / n2;
}

// Places whose mean is that of a pixel: alongCount x acrossCount of them, evenly over a rectangle, each read at a level of the texture whose texels are
// 2^level as wide.
struct Taps {
  Vec2 along, across;  // from one to the next [texels of the texture itself]
  int alongCount, acrossCount;
  int level;
};

// a, b: sides of the parallelogram that a pixel covers [texels]. It becomes the rectangle with the same second moments: Heckbert 1989,
// Fundamentals of Texture Mapping and Image Warping, section 3.4.
// `perTexel`: places a texel, at least; so many across and along, at most. `beside` keeps pixels of a whole number of texels, which are common, off the
// places where the choice changes: single and double precision choose alike.
PHYSICS Taps tapsOf(Vec2 a, Vec2 b, Real perTexel, Real mostAcross, Real mostAlong, int lastLevel) {
  const Real beside = 1.03, endless = 1.0e6;
  // Fourth powers of what is seen edge on have no place in single precision; the last level is read there in any case.
  Real longest = max(dot(a, a), dot(b, b));
  if (longest > endless * endless) {
    a = a * (endless / sqrt(longest));
    b = b * (endless / sqrt(longest));
  }
  Real xx = a.x * a.x + b.x * b.x, yy = a.y * a.y + b.y * b.y, xy = a.x * a.y + b.x * b.y, area = a.x * b.y - a.y * b.x;
  Real difference = xx - yy, root = sqrt(difference * difference + 4.0 * xy * xy), large = 0.5 * (xx + yy + root);
  Real length1 = sqrt(large), length2 = large > 0.0 ? (area < 0.0 ? -area : area) / length1 : 0.0;
  Vec2 axis = difference >= 0.0 ? Vec2(difference + root, 2.0 * xy) : Vec2(2.0 * xy, root - difference);
  Real size = sqrt(axis.x * axis.x + axis.y * axis.y);
  // Round: the sides of the pixel themselves.
  if (root <= 1.0e-3 * large) axis = a, size = sqrt(a.x * a.x + a.y * a.y);
  axis = size > 0.0 ? axis / size : Vec2(1.0, 0.0);
  Taps taps;
  Real need = beside * perTexel, wanted = max(need * length2 / mostAcross, need * length1 / mostAlong);
  taps.level = wanted > 1.0 ? 1 + int(min(floor(1.4426950408889634 * log(wanted)), 30.0)) : 0;
  if (taps.level > lastLevel) taps.level = lastLevel;
  Real texel = ldexp(Real(1.0), taps.level);
  taps.alongCount = int(min(mostAlong, 1.0 + floor(need * length1 / texel)));
  taps.acrossCount = int(min(mostAcross, 1.0 + floor(need * length2 / texel)));
  taps.along = axis * (length1 / Real(taps.alongCount));
  taps.across = Vec2(-axis.y, axis.x) * (length2 / Real(taps.acrossCount));
  return taps;
}

// Two temperatures and the share of the second that have the mean, variance and third central moment of those a pixel covers: the mean of what they
// emit is that of the pixel to third order, and exact where there are two. Source: Gauss quadrature of two points (Golub and Welsch 1969).
PHYSICS Vec3 twoTemperatures(Real mean, Real variance, Real third) {
  Real spread = sqrt(max(variance, 0.0));
  if (!(spread > 1.0e-6 * mean)) return Vec3(mean, mean, 0.5);
  Real skew = 0.5 * third / (spread * spread * spread), reach = sqrt(1.0 + skew * skew);
  Real upper = 0.5 * (1.0 - skew / reach);
  // Of a large skew the difference loses its digits: (1 - s / r) (1 + s / r) = 1 / r^2.
  if (skew > 1.0) upper = 0.5 / (reach * reach * (1.0 + skew / reach));
  Real high = skew < 0.0 ? 1.0 / (reach - skew) : skew + reach;
  return Vec3(max(mean - spread / high, 0.0), mean + spread * high, upper);
}
