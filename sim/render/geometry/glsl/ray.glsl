//@use sim/render/assembly/glsl/view_block.glsl
//@use sim/render/assembly/glsl/draws.glsl
//@use sim/render/geometry/glsl/geometry_buffers.glsl
// The ray of a pixel, met with triangles in body coordinates, and the place of a point of it over the earth.
vec2 film_;          // tangents from the axis
vec3 ray_;           // camera frame, z = -1
float rayLength_;
float sinElevation_; // of the ray at the camera

void prepareRay(vec2 pixel) {
  film_ = (pixel - view.pixel.zw) * view.pixel.xy;
  ray_ = vec3(film_, -1.0);
  rayLength_ = length(ray_);
  sinElevation_ = dot(ray_, view.up.xyz) / rayLength_;
}

vec3 inBody(Draw draw, vec3 camera) { return vec3(dot(draw.row0.xyz, camera), dot(draw.row1.xyz, camera), dot(draw.row2.xyz, camera)); }

// Depth of the plane through the body's origin, across the axis [m]. The ray is pointOnPlane + t d from there, at depth plane + t.
float planeOf(Draw draw) { return -draw.row2.w; }

// Where the ray meets that plane, in body coordinates: its digits are those of the body's own size.
vec3 pointOnPlane(Draw draw) {
  return inBody(draw, vec3(film_ * planeOf(draw) - vec2(draw.row0.w, draw.row1.w), 0.0));
}

// Along the ray from that plane to a triangle, and the triangle's weights there.
struct Meeting {
  float along;
  vec3 weight;
  ivec3 corner;    // in the buffer of vertices
  vec3 side1, side2;
  vec3 geometric;  // normal, not of unit length
};

Meeting meet(uint triangle, vec3 q, vec3 d) {
  Meeting m;
  m.corner = 2 * ivec3(texelFetch(indices, int(triangle)).xyz);
  vec3 a = texelFetch(vertices, m.corner.x).xyz, e1 = texelFetch(vertices, m.corner.y).xyz - a, e2 = texelFetch(vertices, m.corner.z).xyz - a;
  vec3 p = cross(d, e2), s = q - a, r = cross(s, e1);
  float det = dot(e1, p);
  float inverse = det != 0.0 ? 1.0 / det : 0.0;
  float v = clamp(dot(s, p) * inverse, 0.0, 1.0);
  float w = clamp(dot(d, r) * inverse, 0.0, 1.0 - v);
  m.weight = vec3(1.0 - v - w, v, w);
  m.side1 = e1;
  m.side2 = e2;
  m.geometric = cross(e1, e2);
  // On the triangle's plane: its digits are those of the place, not of a triangle that may be 200 km long. On edge no farther than its corners.
  float facing = dot(m.geometric, d), d2 = dot(d, d);
  vec3 corners = vec3(0.0, dot(e1, d), dot(e2, d)) - dot(s, d);
  float slack = 1.0e-6 * sqrt(d2) * (length(e1) + length(e2) + length(s));
  float first = min(corners.x, min(corners.y, corners.z)) - slack, last = max(corners.x, max(corners.y, corners.z)) + slack;
  m.along = clamp(facing != 0.0 ? -dot(m.geometric, s) / facing : dot(e2, r) * inverse, first / d2, last / d2);
  return m;
}

// Height and up (camera frame) of the point at a range, over the sphere: exact at any range.
float heightAt(float range, out vec3 up) {
  float far = min(range, 1.0e9), radius = view.earth.x + view.up.w;  // of the background neither is asked for; squares stay finite
  float grown = far * (2.0 * radius * sinElevation_ + far);
  float distance = sqrt(max(radius * radius + grown, 1.0));
  up = (view.up.xyz * radius + ray_ * (far / rayLength_)) / distance;
  return view.up.w + grown / (distance + radius);
}
