// Spectral radiance of what a pixel sees, through the air, integrated into the channels. Duvenhage 2006 section 4.7 in the
// cancelled form: radiance leaves the fragment, the pixel's projected solid angle and the aperture turn it into flux afterwards.
//@use sim/radiometry/glsl/planck.glsl
//@use sim/radiometry/glsl/geometry.glsl
//@constants
layout(binding = 0) uniform usampler2D visibility;
layout(std430, binding = 0) readonly buffer Vertices { vec4 vertices[]; };
layout(std430, binding = 1) readonly buffer Indices { uint indices[]; };
//@use sim/render/glsl/draws.glsl

layout(std140, binding = 0) uniform ViewBlock {
  vec4 pixel;     // tangent per pixel x, y; film position of the axis (pixels from the lower left)
  vec4 up;        // local up in the camera frame; height of the camera [m]
  vec4 earth;     // earth radius, top of the air [m]; the entity + 1 to be shaded alone, or 0: all and the background
  vec4 sun;       // direction of the sun in the camera frame
  vec4 aperture;  // aperture area [m2], (pitch / focal length)^2 of a whole pixel
  vec4 east;      // local east and north in the camera frame (for truth normals)
  vec4 north;
} view;

layout(std140, binding = 1) uniform NodeBlock {
  vec4 node[NODES];                    // extinction [1/m], air source radiance, c2 / lambda [K], c1L / lambda^5
  vec4 nodeLight[NODES * LIGHT_GROUPS];  // intensity of four lights at a node [W/(sr um)], the sun as irradiance
  vec4 nodeAmbient[NODES];
} nodes;
layout(std140, binding = 2) uniform WeightBlock { vec4 weight[WEIGHTS]; } weights;

// What a pixel sees, set by main().
Draw draw_;
vec3 normal_;     // unit, body frame, towards the viewer
vec3 toViewer_;   // unit, body frame
vec3 point_;      // body frame [m]
vec3 up_;         // up at the point, body frame
vec2 uv_;
float cosView_;
float range_;
float airLength_; // of the camera leg [m]
float height_;    // of the point [m]
float sunElevation_; // sine of it at the point
float isSurface_; // 0 for the background
float lightCos_, lightDistance2_;  // of the first light (truth)

//@slot path
//@slot lobes
//@slot lights
//@slot surface
//@slot truth

//@slot targets
Real nodeRadiance(int i) { return pathSeen(i, selfRadiance(i)) + reflectedLight(i); }
//@slot integrate

void main() {
  uvec2 id = texelFetch(visibility, ivec2(gl_FragCoord.xy), 0).xy;
  draw_ = draws[id.x];  // draw 0 is the background
  if (view.earth.z > 0.0 && float(draw_.table.w) != view.earth.z) discard;
  vec2 film = (gl_FragCoord.xy - view.pixel.zw) * view.pixel.xy;
  vec3 ray = vec3(film, -1.0);
  float rayLength = length(ray);
  float sinElevation = dot(ray, view.up.xyz) / rayLength;
  vec3 d = vec3(dot(draw_.row0.xyz, ray), dot(draw_.row1.xyz, ray), dot(draw_.row2.xyz, ray));
  isSurface_ = id.x == 0u ? 0.0 : 1.0;
  toViewer_ = -d / rayLength;
  normal_ = toViewer_;
  cosView_ = 1.0;
  point_ = vec3(0.0);
  uv_ = vec2(0.0);
  range_ = kFar;
  if (id.x != 0u) {
    // The ray meets the plane through the body's origin, across the line of sight, at a point whose digits are those of the
    // body's own size; from there the triangle is met in body coordinates.
    vec3 origin = vec3(draw_.row0.w, draw_.row1.w, draw_.row2.w);
    float plane = -origin.z;
    vec3 across = vec3(film * plane - origin.xy, 0.0);
    vec3 q = vec3(dot(draw_.row0.xyz, across), dot(draw_.row1.xyz, across), dot(draw_.row2.xyz, across));
    uint t = 3u * id.y;
    uint ia = 2u * indices[t], ib = 2u * indices[t + 1u], ic = 2u * indices[t + 2u];
    vec4 a = vertices[ia], b = vertices[ib], c = vertices[ic];
    vec4 na = vertices[ia + 1u], nb = vertices[ib + 1u], nc = vertices[ic + 1u];
    vec3 e1 = b.xyz - a.xyz, e2 = c.xyz - a.xyz;
    vec3 p = cross(d, e2), s = q - a.xyz, r = cross(s, e1);
    float det = dot(e1, p);
    float inverse = det != 0.0 ? 1.0 / det : 0.0;
    float v = clamp(dot(s, p) * inverse, 0.0, 1.0);
    float w = clamp(dot(d, r) * inverse, 0.0, 1.0 - v);
    float along = dot(e2, r) * inverse;
    float u = 1.0 - v - w;
    point_ = u * a.xyz + v * b.xyz + w * c.xyz;
    range_ = max((plane + along) * rayLength, 1.0e-6);
    uv_ = vec2(u * a.w + v * b.w + w * c.w, u * na.w + v * nb.w + w * nc.w);
    vec3 geometric = cross(e1, e2);
    vec3 n = u * na.xyz + v * nb.xyz + w * nc.xyz;
    if (dot(geometric, d) > 0.0) n = -n;  // seen from behind
    normal_ = normalize(n);
    cosView_ = max(dot(normal_, toViewer_), 1.0e-6);
  }
  // Height and up at the point, over the sphere: exact at any range. Of the background neither is asked for; squares stay finite.
  float far = min(range_, 1.0e9), radius = view.earth.x + view.up.w;
  float grown = far * (2.0 * radius * sinElevation + far);
  float distance = sqrt(max(radius * radius + grown, 1.0));
  height_ = view.up.w + grown / (distance + radius);
  vec3 upThere = (view.up.xyz * radius + ray * (far / rayLength)) / distance;
  up_ = vec3(dot(draw_.row0.xyz, upThere), dot(draw_.row1.xyz, upThere), dot(draw_.row2.xyz, upThere));
  sunElevation_ = dot(upThere, view.sun.xyz);
  airLength_ = airLength(view.up.w, sinElevation, range_);
  prepareSurface();
  prepareLights();
  clearTargets();
  integrate();
  writeTruth(1.0 / rayLength);
}
