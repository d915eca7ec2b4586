// A meshed body's own triangles.
//@use sim/render/glsl/geometry_buffers.glsl
//@use sim/render/glsl/project.glsl
uniform int drawIndex;

void main() {
  project(drawAt(uint(drawIndex)), texelFetch(vertices, 2 * gl_VertexID).xyz);
  gl_ClipDistance[0] = gl_Position.w;  // a medium begins at the camera, not at the near plane
}
