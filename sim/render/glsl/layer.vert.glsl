// Transparent triangles in the order they were sorted into.
//@use sim/render/glsl/geometry_buffers.glsl
//@use sim/render/glsl/project.glsl
layout(std430, binding = 3) readonly buffer Layers { uvec2 layers[]; };  // draw, triangle
flat out uvec2 seen;

void main() {
  seen = layers[gl_VertexID / 3];
  project(drawAt(seen.x), texelFetch(vertices, 2 * int(texelFetch(indices, int(seen.y))[gl_VertexID % 3])).xyz);
}
