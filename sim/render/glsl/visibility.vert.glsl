// Which surface each pixel sees.
//@use sim/render/glsl/geometry_buffers.glsl
//@use sim/render/glsl/project.glsl
//@slot drawn

void main() { project(drawAt(uint(drawnHere())), texelFetch(vertices, 2 * gl_VertexID).xyz); }
