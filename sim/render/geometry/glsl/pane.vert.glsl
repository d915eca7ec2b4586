// A transparent surface's own triangles.
//@use sim/render/geometry/glsl/project.glsl
//@use sim/render/geometry/glsl/drawn_vertices.glsl
uniform int drawIndex;

void main() {
  triangle = triangleHere;
  project(drawAt(uint(drawIndex)), position);
}
