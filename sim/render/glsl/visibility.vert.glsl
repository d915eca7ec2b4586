// Which surface each pixel sees.
//@use sim/render/glsl/project.glsl
//@use sim/render/glsl/drawn_vertices.glsl
//@slot drawn

void main() {
  triangle = triangleHere;
  project(drawAt(uint(drawnHere())), position);
}
