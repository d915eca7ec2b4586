// Transparent triangles in the order they were sorted into.
//@use sim/render/glsl/geometry_buffers.glsl
//@use sim/render/glsl/project.glsl
layout(std430, binding = 3) readonly buffer Layers { uvec2 layers[]; };  // draw, triangle
flat out uvec2 seen;

void main() {
  seen = layers[gl_VertexID / 3];
  project(draws[seen.x], vertices[2u * indices[3u * seen.y + uint(gl_VertexID % 3)]].xyz);
}
