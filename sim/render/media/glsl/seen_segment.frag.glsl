// A segment of a line in emitting gas or smoke, in one medium or where several overlap, whose absorption and emission add: PHYSICS section 2, see
// mediumRadiance().
//@use sim/radiometry/glsl/medium.glsl
//@constants
//@use sim/render/geometry/glsl/ray.glsl
//@use sim/radiometry/glsl/geometry.glsl
//@use sim/render/assembly/glsl/node_block.glsl
layout(binding = 5) uniform samplerBuffer media;   // of four nodes: absorption [1/m]; source radiance
layout(binding = 17) uniform usamplerBuffer rows;  // of each segment: the number of its media, their rows
layout(binding = 18) uniform usamplerBuffer list;  // pixel, where its rows are; depth of its near end and its length [m], floats
//@use sim/render/media/glsl/listed_entry.glsl
//@slot targets
float sunElevation_;

//@slot path
AirPath near_, far_;  // from the camera to the near end, and on to the other
float length_;        // [m]
int row_, media_;

void segmentAt(int four, out vec4 through, out vec4 own) {
  vec4 depth = vec4(0.0), emitted = vec4(0.0);
  for (int k = 0; k < media_; ++k) {
    int row = int(texelFetch(rows, row_ + k).x) + 2 * four;
    vec4 each = texelFetch(media, row) * length_;
    depth += each;
    emitted += each * texelFetch(media, row + 1);
  }
//@each j 4
  {
    int i = min(4 * four + {j}, NODES - 1);
    Real air = pathDepth(i, near_, far_);
    Real before = pathRadiance(i, near_), tau = pathTransmittance(i, near_), inside = pathInside(i, near_, far_);
    through[{j}] = decay(depth[{j}]);
    Real seen = mediumRadiance(depth[{j}], air, before, inside, tau, emitted[{j}] / max(depth[{j}], 1.0e-30));
    own[{j}] = depth[{j}] > 0.0 ? seen - through[{j}] * (before + inside) : 0.0;
  }
//@end
}

void main() {
  int entry = listedEntry();
  uvec4 segment = texelFetch(list, entry);
  prepareRay(vec2(segment.x & 0xffffu, segment.x >> 16) + 0.5);
  row_ = int(segment.y) + 1;
  media_ = int(texelFetch(rows, row_ - 1).x);
  vec2 depths = uintBitsToFloat(segment.zw);
  length_ = depths.y * rayLength_;
  float range = max(depths.x * rayLength_, 0.0);
  vec3 upThere;
  float height = heightAt(range, upThere);
  sunElevation_ = 0.0;
  near_ = airFromCamera(range);
  far_ = airBeyond(near_, range, height, dot(upThere, ray_) / rayLength_, length_);
  vec4 through, own;
//@each t TARGETS
  segmentAt(fourOf({t}), through, own);
  storePassage(entry, {t}, through, own);
//@end
}
