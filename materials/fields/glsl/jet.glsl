// One round free jet, as materials/fields/free_jet.hpp has it, in excess over the air around. Shared by GLSL (float) and C++ (double).

// Profile over radius: 1 up to a core's border, a Gaussian's shoulder of this width beyond, its centre fallen where the shape is below 0.
PHYSICS Real jetProfile(Real shape, Real width, Real nozzleRadius, Real r) {
  Real beyond = r - nozzleRadius * max(shape, 0.0);
  Real x = width > 0.0 ? beyond / width : 10.0;
  Real f = beyond > 0.0 ? exp(-min(x * x, 80.0)) : 1.0;  // exp(-80): a normal number in single precision, and nothing
  return f / (1.0 - min(shape, 0.0));
}

// Where x lies among the rows (x, shapeU, widthU, shapeZ). scale: 1/rowScale, 1/rowLogRatio, coreLength, 1/farLogRatio.
PHYSICS Real jetRow(Real x, Vec4 scale, Real coreRow) {
  return x < scale.z ? log(1.0 + x * scale.x) * scale.y : coreRow + log(x / scale.z) * scale.w;
}

// Mixture fraction and excess speed, as parts of those at the nozzle, at a radius. row: (x, shapeU, widthU, shapeZ).
PHYSICS Vec2 jetMixture(Vec4 row, Real nozzleRadius, Real r) {
  Real widthZ = row.z * sqrt(1.0 + 0.428571428571429 * (1.0 - 1.0 / (1.0 - min(row.y, 0.0))));
  return Vec2(jetProfile(row.w, widthZ, nozzleRadius, r), jetProfile(row.y, row.z, nozzleRadius, r));
}

// Temperature [K] there. flow: ambient temperature, excess speed, ambient speed, excess enthalpy - cpExcess x ambient temperature; heat: cp, cpExcess.
PHYSICS Real jetTemperature(Vec2 mixture, Vec4 flow, Vec4 heat) {
  Real excess = flow.y * mixture.y;
  return flow.x + (flow.w * mixture.x - excess * (0.5 * excess + flow.z)) / (heat.x + heat.y * mixture.x);
}
