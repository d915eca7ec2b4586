// Which surface each pixel sees.
//@use sim/render/geometry/glsl/project.glsl
//@use sim/render/geometry/glsl/drawn_vertices.glsl
//@slot drawn

void main() {
  triangle = triangleHere;
  project(drawAt(uint(drawnHere())), position);
}
