// A body as a light sees it, for its depth map.
layout(location = 0) in vec3 position;  // body frame [m]
uniform vec4 mapFromBody[4];
uniform float texels;

void main() {
  vec4 p = vec4(position, 1.0);
  float w = dot(mapFromBody[3], p);
  gl_Position = vec4(vec2(dot(mapFromBody[0], p), dot(mapFromBody[1], p)) * (2.0 / texels) - w, dot(mapFromBody[2], p), w);
}
