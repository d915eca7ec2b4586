// A flat Lambertian face's intensity by that along its normal: cos(theta); 0 behind it. The integral over all directions is pi.
//   parameters.x: along its normal, 1.
// Source: Lambert 1760.
PHYSICS Real areaPattern(Vec4 parameters, Vec3 direction) {
  return parameters.x * max(direction.x, 0.0);
}
