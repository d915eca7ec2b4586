//@use sim/radiometry/glsl/exponential.glsl
// Air from tables: -ln tau = sum of c_k R^a_k with R the length of the whole way [km], both legs in one; L_path = J (1 - tau).
// Valid: all lengths, infinite included. The block: atmosphere/tabulated_gpu.hpp; J [W/(m2 sr um)] is in nodes.node[i].y.
layout(std140, binding = 3) uniform PathBlock {
  vec4 exponent[AIR_VECTORS];
} air;
//@slot air_extinction

struct AirPath {
  float length;              // [m]
//@each v AIR_VECTORS
  vec4 u{v};       // R^a_k
  vec4 beyond{v};  // what the last stretch adds to them
//@end
};

AirPath airOf(float length) {
  AirPath p;
  p.length = length;
  float km = 1.0e-3 * length;
//@each v AIR_VECTORS
  p.u{v} = km > 0.0 ? mix(exp(air.exponent[{v}] * log(km)), vec4(km), equal(air.exponent[{v}], vec4(1.0))) : vec4(0.0);  // plain Beer's law keeps its digits
  p.beyond{v} = vec4(0.0);
//@end
  return p;
}

AirPath airFromCamera(float range) { return airOf(range); }

// (n + s)^a - n^a = (n + s)^a (1 - exp(-a ln(1 + s / n))): a far small body's stretch keeps its digits.
AirPath airBeyond(AirPath near, float nearRange, float height, float sinElevation, float length) {
  AirPath p = airOf(near.length + length);
  if (near.length > 0.0 && length > 0.0) {
    float ratio = -logOneMinus(length / p.length);
//@each v AIR_VECTORS
    for (int c = 0; c < 4; ++c) p.beyond{v}[c] = p.u{v}[c] * oneMinusExp(air.exponent[{v}][c] * ratio);
//@end
  } else if (length > 0.0) {
//@each v AIR_VECTORS
    p.beyond{v} = p.u{v};
//@end
  }
  return p;
}

AirPath airToSun(AirPath camera, float height) { return camera; }

AirPath airToLight(AirPath camera, float height, float sinElevation, float distance) { return airOf(camera.length + distance); }

Real airDepth(int i, AirPath p) {
  Real depth = 0.0;
//@each v AIR_VECTORS
  depth += dot(airExtinction(i * AIR_VECTORS + {v}), p.u{v});
//@end
  return depth;
}

Real pathDepth(int i, AirPath near, AirPath far) {
  Real depth = 0.0;
//@each v AIR_VECTORS
  depth += dot(airExtinction(i * AIR_VECTORS + {v}), far.beyond{v});
//@end
  return depth;
}

Real pathTransmittance(int i, AirPath p) { return exp(-airDepth(i, p)); }

Real pathRadiance(int i, AirPath p) { return nodes.node[i].y * oneMinusExp(airDepth(i, p)); }

Real pathInside(int i, AirPath near, AirPath far) { return pathTransmittance(i, near) * nodes.node[i].y * oneMinusExp(pathDepth(i, near, far)); }

Real pathSeen(int i, AirPath p, Real radiance) {
  Real depth = airDepth(i, p);
  return radiance * exp(-depth) + nodes.node[i].y * oneMinusExp(depth);
}
