// A body as a light sees it, for its depth map.
//@use sim/render/glsl/geometry_buffers.glsl
uniform vec4 mapFromBody[4];
uniform float texels;

void main() {
  vec4 p = vec4(texelFetch(vertices, 2 * gl_VertexID).xyz, 1.0);
  float w = dot(mapFromBody[3], p);
  gl_Position = vec4(vec2(dot(mapFromBody[0], p), dot(mapFromBody[1], p)) * (2.0 / texels) - w, dot(mapFromBody[2], p), w);
}
