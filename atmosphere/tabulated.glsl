//@use sim/radiometry/glsl/exponential.glsl
// Air from tables: -ln tau = sum of c_k R^a_k with R the length of the whole way [km], both legs in one; L_path = J (1 - tau).
// Valid: all lengths, infinite included. The block: atmosphere/tabulated_gpu.hpp; J [W/(m2 sr um)] is in nodes.node[i].y.
layout(std140, binding = 3) uniform PathBlock {
  vec4 exponent[AIR_VECTORS];
  vec4 extinction[NODES * AIR_VECTORS];
} air;

struct AirPath {
  float length;              // [m]
  vec4 u[AIR_VECTORS];       // R^a_k
  vec4 beyond[AIR_VECTORS];  // what the last stretch adds to them
};

AirPath airOf(float length) {
  AirPath p;
  p.length = length;
  float km = 1.0e-3 * length;
  for (int v = 0; v < AIR_VECTORS; ++v) {
    vec4 a = air.exponent[v];
    p.u[v] = km > 0.0 ? mix(exp(a * log(km)), vec4(km), equal(a, vec4(1.0))) : vec4(0.0);  // plain Beer's law keeps its digits
    p.beyond[v] = vec4(0.0);
  }
  return p;
}

AirPath airFromCamera(float range) { return airOf(range); }

// (n + s)^a - n^a = (n + s)^a (1 - exp(-a ln(1 + s / n))): a far small body's stretch keeps its digits.
AirPath airBeyond(AirPath near, float nearRange, float height, float sinElevation, float length) {
  AirPath p = airOf(near.length + length);
  if (near.length > 0.0 && length > 0.0) {
    float ratio = -logOneMinus(length / p.length);
    for (int v = 0; v < AIR_VECTORS; ++v)
      for (int c = 0; c < 4; ++c) p.beyond[v][c] = p.u[v][c] * oneMinusExp(air.exponent[v][c] * ratio);
  } else if (length > 0.0) {
    p.beyond = p.u;
  }
  return p;
}

AirPath airToSun(AirPath camera, float height) { return camera; }

AirPath airToLight(AirPath camera, float height, float sinElevation, float distance) { return airOf(camera.length + distance); }

Real airDepth(int i, AirPath p) {
  Real depth = 0.0;
  for (int v = 0; v < AIR_VECTORS; ++v) depth += dot(air.extinction[i * AIR_VECTORS + v], p.u[v]);
  return depth;
}

Real pathDepth(int i, AirPath near, AirPath far) {
  Real depth = 0.0;
  for (int v = 0; v < AIR_VECTORS; ++v) depth += dot(air.extinction[i * AIR_VECTORS + v], far.beyond[v]);
  return depth;
}

Real pathTransmittance(int i, AirPath p) { return exp(-airDepth(i, p)); }

Real pathRadiance(int i, AirPath p) { return nodes.node[i].y * oneMinusExp(airDepth(i, p)); }

Real pathInside(int i, AirPath near, AirPath far) { return pathTransmittance(i, near) * nodes.node[i].y * oneMinusExp(pathDepth(i, near, far)); }

Real pathSeen(int i, AirPath p, Real radiance) {
  Real depth = airDepth(i, p);
  return radiance * exp(-depth) + nodes.node[i].y * oneMinusExp(depth);
}
