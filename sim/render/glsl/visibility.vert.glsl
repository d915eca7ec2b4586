// Which surface each pixel sees. Bodies of one mesh are instances of one draw.
//@use sim/render/glsl/geometry_buffers.glsl
//@use sim/render/glsl/project.glsl
layout(std430, binding = 7) readonly buffer Instances { uint drawOfInstance[]; };
uniform int firstInstance;
flat out uint drawIndex;

void main() {
  drawIndex = drawOfInstance[firstInstance + gl_InstanceID];
  project(draws[drawIndex], vertices[2 * gl_VertexID].xyz);
}
