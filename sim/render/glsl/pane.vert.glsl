// A transparent surface's own triangles.
//@use sim/render/glsl/project.glsl
//@use sim/render/glsl/drawn_vertices.glsl
uniform int drawIndex;

void main() {
  triangle = triangleHere;
  project(drawAt(uint(drawIndex)), position);
}
