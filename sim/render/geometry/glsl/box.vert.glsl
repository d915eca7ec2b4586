// A box in body axes: around a medium (its back alone: each ray through the body leaves the box once, from inside too), or around a body
// whose place in the picture may be hidden.
//@use sim/render/geometry/glsl/project.glsl
uniform int drawIndex;
uniform vec3 low;
uniform vec3 high;

void main() {
  // Two triangles a side, counter-clockwise from outside.
  int side = gl_VertexID / 6, k = gl_VertexID % 6;
  int corner = k < 3 ? k : (k == 3 ? 0 : k - 2);
  vec2 uv = vec2(corner == 1 || corner == 2 ? 1.0 : 0.0, corner >= 2 ? 1.0 : 0.0);
  bool positive = side >= 3;
  if (!positive) uv = uv.yx;
  int axis = side % 3;
  float across = positive ? 1.0 : 0.0;
  vec3 at = axis == 0 ? vec3(across, uv) : axis == 1 ? vec3(uv.y, across, uv.x) : vec3(uv, across);
  project(drawAt(uint(drawIndex)), mix(low, high, at));
  gl_ClipDistance[0] = gl_Position.w;  // llvmpipe clips at it where GL_CLIP_DISTANCE0 is off, too
}
