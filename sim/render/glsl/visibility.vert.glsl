// Which surface each pixel sees: vertices to the film, in camera-relative single precision.
layout(std430, binding = 0) readonly buffer Vertices { vec4 vertices[]; };  // per vertex: (position, u), (normal, v)
//@use sim/render/glsl/draws.glsl
uniform int drawIndex;
uniform vec4 film;       // 2 / (width tanX), 2 / (height tanY), clip offset x, y
uniform vec3 depthRule;  // near; 0: reversed depth near / z, or the scale of depth around a body's centre

void main() {
  Draw draw = draws[drawIndex];
  vec3 body = vertices[2 * gl_VertexID].xyz;
  // The rotation is stored body from camera: its transpose turns the vertex. z relative to the body's origin keeps its digits.
  vec3 turned = body.x * draw.row0.xyz + body.y * draw.row1.xyz + body.z * draw.row2.xyz;
  vec3 camera = turned + vec3(draw.row0.w, draw.row1.w, draw.row2.w);
  float w = -camera.z;
  // Around a small far body: 0.5 + scale (z - centre) / w, from differences that keep their digits; both forms are affine in the
  // position, so that planes stay planes. What lies beyond is clamped to nearest or farthest.
  float depth = depthRule.y == 0.0 ? depthRule.x : 0.5 * w + depthRule.y * (turned.z + draw.state.w);
  gl_ClipDistance[0] = w - depthRule.x;
  gl_Position = vec4(camera.x * film.x + film.z * w, camera.y * film.y + film.w * w, depth, w);
}
