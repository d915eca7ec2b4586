// Which surface each pixel sees.
//@use sim/render/glsl/geometry_buffers.glsl
//@use sim/render/glsl/project.glsl
uniform int drawIndex;

void main() { project(draws[drawIndex], vertices[2 * gl_VertexID].xyz); }
