// Several bodies of emitting gas or smoke that may lie in each other: the ray is cut at every border, and where bodies overlap their
// absorption and emission add. See volume.frag.glsl for one.
//@use sim/radiometry/glsl/chord.glsl
//@use sim/radiometry/glsl/medium.glsl
//@constants
//@use sim/render/glsl/volume_ray.glsl
//@use sim/render/glsl/node_block.glsl
layout(binding = 5) uniform samplerBuffer media;  // of four nodes: absorption [1/m]; source radiance
// Each member's box is drawn; a pixel is worked out in the first that it lies in, for all of them, and marked by depth before it is.
layout(early_fragment_tests) in;
uniform int count;
uniform int memberDraw[GROUP];
uniform int memberForm[GROUP];
uniform vec3 memberSize[GROUP];
uniform int memberRow[GROUP];

float sunElevation_;
float plane_;                // of the first one
vec2 way_[GROUP];            // of each member that the ray meets: t along the ray from the plane of the first one's origin
int row_[GROUP];
int met_;
float cut_[2 * GROUP];       // borders, falling
int cuts_;

//@slot path
// Between two borders, the farthest pair first.
int piece_;
float length_;   // [m]
AirPath near_;   // from the camera to the nearer border
AirPath far_;    // and on to the other

int layersHere() { return cuts_ - 1; }

void prepareLayer(int c) {
  piece_ = c;
  length_ = (cut_[c] - cut_[c + 1]) * rayLength_;
  float range = max((plane_ + cut_[c + 1]) * rayLength_, 0.0);
  vec3 upThere;
  float height = heightAt(range, upThere);
  near_ = airFromCamera(range);
  far_ = airBeyond(near_, range, height, dot(upThere, ray_) / rayLength_, length_);
}

// Four nodes at once. No branch: what they have in common is then read once for all of them.
vec4 blendedFour(vec4 behind, int four) {
  vec4 depth = vec4(0.0), emitted = vec4(0.0), result;
  for (int k = 0; k < met_; ++k) {
    if (!(way_[k].x <= cut_[piece_ + 1] && way_[k].y >= cut_[piece_])) continue;
    vec4 own = texelFetch(media, row_[k] + 2 * four) * length_;
    depth += own;
    emitted += own * texelFetch(media, row_[k] + 2 * four + 1);
  }
//@each j 4
  {
    int i = min(4 * four + {j}, NODES - 1);
    Real air = pathDepth(i, near_, far_);
    Real before = pathRadiance(i, near_), tau = pathTransmittance(i, near_), inside = pathInside(i, near_, far_);
    Real own = mediumRadiance(depth[{j}], air, before, inside, tau, emitted[{j}] / max(depth[{j}], 1.0e-30));
    result[{j}] = depth[{j}] > 0.0 ? decay(depth[{j}]) * (behind[{j}] - (before + inside)) + own : behind[{j}];
  }
//@end
  return result;
}

//@slot targets
//@slot blend

void main() {
  prepareRay(gl_FragCoord.xy);
  Draw first = drawAt(uint(memberDraw[0]));
  float start = -planeOf(first);  // the camera
  float end = endOfRay(first);
  cuts_ = 0;
  met_ = 0;
  for (int k = 0; k < count; ++k) {
    Draw body = drawAt(uint(memberDraw[k]));
    vec3 d = inBody(body, ray_), q = pointOnPlane(body);
    vec2 chord = memberForm[k] == 1 ? ellipsoidChord(q, d, memberSize[k]) : coneChord(q, d, memberSize[k].x, memberSize[k].y, memberSize[k].z);
    float shift = (first.row2.w - body.row2.w) + (first.fine.x - body.fine.x);
    vec2 way = vec2(max(chord.x + shift, start), min(chord.y + shift, end));
    if (!(chord.y > chord.x && way.y > way.x)) continue;
    way_[met_] = way;
    row_[met_] = memberRow[k];
    ++met_;
    for (int side = 0; side < 2; ++side) {
      float border = side == 0 ? way.x : way.y;
      int at = cuts_;
      for (; at > 0 && cut_[at - 1] < border; --at) cut_[at] = cut_[at - 1];
      cut_[at] = border;
      ++cuts_;
    }
  }
  if (met_ == 0) discard;
  sunElevation_ = 0.0;
  plane_ = planeOf(first);
  blend();
}
