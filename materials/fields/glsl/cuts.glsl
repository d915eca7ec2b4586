// Steps along a line, as a measure that rises with t: sigma = arsinh((t - nearest)/scale), even where the line passes what is finest far away and geometric
// from there where it runs close by. scale: t of the closest approach, 1/scale. Shared by GLSL (float) and C++ (double).
PHYSICS Real cutSigma(Real t, Vec2 scale) {
  Real x = (t - scale.x) * scale.y;
  Real a = log(max(x, -x) + sqrt(x * x + 1.0));
  return x < 0.0 ? -a : a;
}

// Its inverse: t.
PHYSICS Real cutPlace(Real sigma, Vec2 scale) {
  Real e = exp(sigma);
  return scale.x + 0.5 * (e - 1.0 / e) / scale.y;
}
