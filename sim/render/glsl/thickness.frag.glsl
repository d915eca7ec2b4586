// Path length inside a closed mesh: leaving minus entering, summed by additive blending over its triangles, each where the ray meets it
// or where the ray ends. Lengths are taken from the plane of the body's origin: digits of the body's own size.
layout(location = 0) out vec4 sums;    // sum of +-t, sum of +-1
layout(location = 1) out vec4 bounds;  // greatest of -t entering, and of t leaving
//@use sim/render/glsl/volume_ray.glsl
flat in uint triangle;

void main() {
  prepareRay(gl_FragCoord.xy);
  Draw body = drawAt(uint(drawIndex));
  Meeting m = meet(triangle, pointOnPlane(body), inBody(body, ray_));
  float t = min(m.along, endOfRay(body)), sense = gl_FrontFacing ? -1.0 : 1.0;
  sums = vec4(sense * t, sense, 0.0, 0.0);
  bounds = gl_FrontFacing ? vec4(-t, -kFar, 0.0, 0.0) : vec4(-kFar, t, 0.0, 0.0);
}
