// One drawn part of an entity. Rows turn camera directions into body ones; their w is the body's origin in the camera frame.
struct Draw {
  vec4 row0;
  vec4 row1;
  vec4 row2;
  uvec4 table;  // self or temperature row, material, temperature texture + 1, entity + 1
  vec4 state;   // temperature [K], part, row of its lights, z of its origin from the depth centre [m]
  vec4 fine;    // what row2.w lost by rounding [m]; depth of its class
};
layout(std430, binding = 2) readonly buffer Draws { Draw draws[]; };
