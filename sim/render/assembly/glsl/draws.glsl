//@use sim/render/assembly/glsl/view_block.glsl
// One drawn part of an entity. Rows turn camera directions into body ones; their w is the body's origin in the camera frame.
struct Draw {
  vec4 row0;
  vec4 row1;
  vec4 row2;
  uvec4 table;  // self or temperature row, material, temperature texture + 1, entity + 1
  vec4 state;   // temperature [K], part, row of its lights, z of its origin from the depth centre [m]
  vec4 fine;    // what row2.w lost by rounding [m]; depth of its class with the sun alone (that without shadows is the next), and with every light
};
// Textures of buffers: llvmpipe reads storage buffers three times as slowly.
layout(binding = 8) uniform usamplerBuffer draws;
uvec4 drawTexel(uint draw, int member) { return texelFetch(draws, 6 * (int(view.depth.z) + int(draw)) + member); }
vec4 drawMember(uint draw, int member) { return uintBitsToFloat(drawTexel(draw, member)); }
Draw drawAt(uint draw) {
  return Draw(drawMember(draw, 0), drawMember(draw, 1), drawMember(draw, 2), drawTexel(draw, 3), drawMember(draw, 4), drawMember(draw, 5));
}
