// What a shader knows of a material.
struct MaterialShape {
  uvec4 counts;        // entries along angle 1, angle 2, view angle; first column entry
  uvec4 kinds;         // angle 1, angle 2; 1 where the emissivity follows Kirchhoff; first hemispherical entry
  vec4 scale;          // entries per radian along angle 1, angle 2, view angle
  ivec4 transmission;  // texture of T or -1; first entry of the transmittances; texture of E or -1
  ivec4 state;         // texture of its state or -1; entries
  vec4 stateScale;     // state of the first entry; entries per unit of it
  ivec4 component[COMPONENTS];  // of R1, R2, ...: its lobe, from 1 on, or 0; its texture or -1
  vec4 lobe[COMPONENTS];        // what that takes
};
layout(std430, binding = 6) readonly buffer Materials { MaterialShape materials[]; };
