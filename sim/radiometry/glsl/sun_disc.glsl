//@use sim/radiometry/glsl/arc_tangent.glsl
// The sun's disc at a point over a spherical earth. Shared by GLSL (float) and C++ (double). Straight lines: refraction, which lifts a sun on the
// horizon by half a degree, is left out, as everywhere here.

// Half the sun's width at its mean distance [rad]: 6.7943e-5 sr = pi r^2; 0.533 degrees across.
PHYSICS Real sunRadius() { return 4.65053e-3; }

// Height of the sun's centre above the point's own horizon, in radii of the sun's disc: 1 and more, all of it is up; -1 and less, none.
//   sin(e + d) / sin(radius), e elevation of the centre, d = acos(R / (R + h)) dip of the horizon seen from a height h over a sphere of radius R.
//   From below the sphere the horizon is level. Valid: all h; a sun above the level is all up, however far the horizon drops.
PHYSICS Real sunAboveHorizon(Real height_m, Real sinElevation, Real earthRadius_m) {
  Real h = max(height_m, 0.0);
  Real cosElevation = sqrt(max(1.0 - sinElevation * sinElevation, 0.0));
  Real sine = (sinElevation * earthRadius_m + cosElevation * sqrt(h * (2.0 * earthRadius_m + h))) / (earthRadius_m + h);
  return (sinElevation > sunRadius() ? max(sine, sinElevation) : sine) / sunRadius();
}

// Share of the disc above the horizon, x of its radii below its centre: a circle's segment,
//   1/2 + (asin x + x sqrt(1 - x^2)) / pi,  asin x = 2 atan(x / (1 + sqrt(1 - x^2))).
// Source: plane geometry; the disc taken as evenly bright (its limb is darker).
PHYSICS Real sunShare(Real x) {
  if (x >= 1.0) return 1.0;
  if (x <= -1.0) return 0.0;
  Real root = sqrt(1.0 - x * x), angle = arcTangent(max(x, -x) / (1.0 + root));
  return 0.5 + ((x < 0.0 ? -2.0 : 2.0) * angle + x * root) * 0.318309886183790672;
}

// How far the middle of what is up lies above the centre of the whole, in radii: moment of the segment over its area,
//   2/3 (1 - x^2)^(3/2) / (pi share).
PHYSICS Real sunRise(Real x) {
  if (x >= 1.0) return 0.0;
  Real root = sqrt(max(1.0 - x * x, 0.0)), share = sunShare(x);
  // So little that single precision has lost its area: the middle of a thin segment is 2/5 of its height above the horizon.
  return share < 1.0e-4 ? max(-x, 0.0) + 0.4 * max(1.0 + x, 0.0) : 0.212206590789193781 * root * root * root / share;
}
