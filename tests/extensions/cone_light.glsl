// A cone's share of the intensity on its axis: all within an inner angle, none beyond an outer one, smooth between.
//   parameters: cosines of the inner and of the outer angle.
PHYSICS Real coneLight(Vec4 parameters, Vec3 direction) {
  Real t = min(max((direction.x - parameters.y) / (parameters.x - parameters.y), 0.0), 1.0);
  return t * t * (3.0 - 2.0 * t);
}
