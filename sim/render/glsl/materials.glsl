// What a shader knows of a material.
struct MaterialShape {
  uvec4 counts;     // entries along angle 1, angle 2, view angle; first column entry
  uvec4 kinds;      // angle 1, angle 2; 1 where the emissivity follows Kirchhoff; first hemispherical entry
  vec4 scale;       // entries per radian along angle 1, angle 2, view angle
  vec4 exponent;    // lobe exponents of R1, R2, R3; 0 has none
  ivec4 modifier;   // textures of R1, R2, R3, E or -1
  ivec4 transmission;  // texture of T or -1; first entry of the transmittances
};
layout(std430, binding = 6) readonly buffer Materials { MaterialShape materials[]; };
