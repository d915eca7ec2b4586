// Spectral radiance of what a pixel sees, through the air. Duvenhage 2006 section 4.7 in the cancelled form: radiance leaves the
// fragment, the pixel's projected solid angle and the aperture turn it into flux afterwards.
//@use sim/radiometry/glsl/planck.glsl
//@use sim/radiometry/glsl/geometry.glsl
//@use sim/radiometry/glsl/ground.glsl
//@use sim/radiometry/glsl/footprint.glsl
//@constants
//@use sim/render/geometry/glsl/ray.glsl
//@use sim/render/assembly/glsl/node_block.glsl
//@slot weights

// What a pixel sees, set by lookAt().
Draw draw_;
vec3 normal_;     // unit, body frame, towards the viewer
vec3 toViewer_;   // unit, body frame
vec3 point_;      // body frame [m]
vec3 facet_;      // outward normal of the triangle itself, not of unit length, body frame
vec3 up_;         // up at the point, body frame
vec2 uv_, uvAcross_, uvUp_;  // at the point; over the sides of the pixel
float cosView_;
float range_;
float height_;    // of the point [m]
float sunElevation_; // sine of it at the point
float isSurface_; // 0 for the background
uint triangle_;
float lightCos_, lightDistance2_;  // of the first light (truth)

//@slot outputs
//@slot targets

//@slot path
AirPath air_;     // of the camera leg
//@slot lobes
//@slot lights
//@slot surface
//@slot truth

Real nodeRadianceUnlit(int i) { return pathSeen(i, air_, selfRadiance(i)); }
Real nodeRadiance(int i) { return pathSeen(i, air_, selfRadiance(i)) + reflectedLight(i); }
//@slot integrate

// id: draw (0 is the background), triangle; where in the picture [pixels from the lower left].
void lookAt(uvec2 id, vec2 pixel) {
  prepareRay(pixel);
  // What meets no body and goes down ends at the ground.
  float ground = SURFACES > 0 && GROUND >= 0 && id.x == 0u ? groundRange(view.up.w, sinElevation_, view.earth.x) : kFar;
  triangle_ = id.y;
  draw_ = drawAt(ground < kFar ? uint(max(GROUND, 0)) : id.x);
  vec3 d = inBody(draw_, ray_);
  isSurface_ = id.x == 0u && ground >= kFar ? 0.0 : 1.0;
  toViewer_ = -d / rayLength_;
  normal_ = toViewer_;
  facet_ = toViewer_;
  cosView_ = 1.0;
  point_ = vec3(0.0);
  uv_ = uvAcross_ = uvUp_ = vec2(0.0);
  range_ = max(ground, 1.0e-6);
  if (SURFACES > 0 && id.x != 0u) {
    vec3 q = pointOnPlane(draw_);
    Meeting m = meet(id.y, q, d);
    float ua = texelFetch(vertices, m.corner.x).w, ub = texelFetch(vertices, m.corner.y).w, uc = texelFetch(vertices, m.corner.z).w;
    vec4 na = texelFetch(vertices, m.corner.x + 1), nb = texelFetch(vertices, m.corner.y + 1), nc = texelFetch(vertices, m.corner.z + 1);
    vec3 w = m.weight;
    facet_ = m.geometric;
    point_ = q + m.along * d;
    range_ = max((planeOf(draw_) + m.along) * rayLength_, 1.0e-6);
    uv_ = vec2(w.x * ua + w.y * ub + w.z * uc, w.x * na.w + w.y * nb.w + w.z * nc.w);
    float depth = planeOf(draw_) + m.along;
    vec2 uv1 = vec2(ub - ua, nb.w - na.w), uv2 = vec2(uc - ua, nc.w - na.w);
    uvAcross_ = uvStep(inBody(draw_, vec3(view.pixel.x, 0.0, 0.0)), d, depth, m.geometric, m.side1, m.side2, uv1, uv2);
    uvUp_ = uvStep(inBody(draw_, vec3(0.0, view.pixel.y, 0.0)), d, depth, m.geometric, m.side1, m.side2, uv1, uv2);
    vec3 n = w.x * na.xyz + w.y * nb.xyz + w.z * nc.xyz;
    if (dot(m.geometric, d) > 0.0) n = -n;  // seen from behind
    normal_ = normalize(n);
    cosView_ = max(dot(normal_, toViewer_), 1.0e-6);
  }
  vec3 upThere;
  height_ = heightAt(range_, upThere);
  up_ = inBody(draw_, upThere);
  if (ground < kFar) {
    height_ = min(view.up.w, 0.0);
    normal_ = up_;
    facet_ = up_;
    cosView_ = max(dot(normal_, toViewer_), 1.0e-6);
  }
  sunElevation_ = dot(upThere, view.sun.xyz);
  air_ = airFromCamera(range_);
  prepareSurface();
  prepareLights();
}
