// A meshed body's own triangles.
//@use sim/render/geometry/glsl/project.glsl
//@use sim/render/geometry/glsl/drawn_vertices.glsl
uniform int drawIndex;

void main() {
  triangle = triangleHere;
  project(drawAt(uint(drawIndex)), position);
  gl_ClipDistance[0] = gl_Position.w;  // a medium begins at the camera, not at the near plane
}
