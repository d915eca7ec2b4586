//@use sim/render/assembly/glsl/view_block.glsl
//@use sim/render/assembly/glsl/draws.glsl
// Vertices to the film, in camera-relative single precision.
void project(Draw draw, vec3 body) {
  // The rotation is stored body from camera: its transpose turns the vertex. z relative to the body's origin keeps its digits.
  vec3 turned = body.x * draw.row0.xyz + body.y * draw.row1.xyz + body.z * draw.row2.xyz;
  vec3 camera = turned + vec3(draw.row0.w, draw.row1.w, draw.row2.w);
  float w = -camera.z;
  // Around a small far body: 0.5 + scale (z - centre) / w, from differences that keep their digits; both forms are affine in the
  // position, so that planes stay planes. What lies beyond is clamped to nearest or farthest.
  float depth = view.depth.y == 0.0 ? view.depth.x : 0.5 * w + view.depth.y * (turned.z + draw.state.w);
  gl_ClipDistance[0] = w - view.depth.x;
  gl_Position = vec4(camera.x * view.film.x + view.film.z * w, camera.y * view.film.y + view.film.w * w, depth, w);
}
