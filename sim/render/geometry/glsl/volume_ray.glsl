//@use sim/render/geometry/glsl/ray.glsl
//@use sim/radiometry/glsl/geometry.glsl
//@slot ground_end
// How far a ray through a medium's body may count: t along the ray from the plane of the body's origin.
layout(binding = 0) uniform usampler2D visibility;

// Depths of planes are compared in two parts each: the difference of the large ones is exact where they are near each other.
float endOfRay(Draw body, ivec2 pixel) {
  uvec2 id = texelFetch(visibility, pixel, 0).xy;
  float end = kFar - planeOf(body);
  if (id.x != 0u) {
    Draw solid = drawAt(id.x);
    Meeting m = meet(id.y, pointOnPlane(solid), inBody(solid, ray_));
    end = min(end, m.along + ((body.row2.w - solid.row2.w) + (body.fine.x - solid.fine.x)));
  } else {
    end = min(end, groundDepth() - planeOf(body));
  }
  return end;
}
