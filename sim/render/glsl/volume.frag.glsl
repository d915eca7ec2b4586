// One body of emitting gas or smoke over the spectral image: PHYSICS section 2, see mediumRadiance().
//@use sim/radiometry/glsl/chord.glsl
//@use sim/radiometry/glsl/medium.glsl
//@constants
//@use sim/render/glsl/volume_ray.glsl
//@use sim/render/glsl/node_block.glsl
layout(binding = 5) uniform samplerBuffer media;      // of four nodes: absorption [1/m]; source radiance
layout(binding = 17) uniform sampler2D thicknessSums;  // of a meshed body
layout(binding = 19) uniform sampler2D thicknessBounds;
uniform int form;      // 0 mesh, 1 ellipsoid, 2 cone
uniform vec3 formSize;
uniform int mediumRow;

float pathLength_;    // inside the medium [m]
float sunElevation_;

//@slot path
AirPath near_, far_;  // from the camera to where the ray enters and leaves

// One thing of its own.
int layersHere() { return 1; }
void prepareLayer(int k) {}

vec4 blendedFour(vec4 behind, int four) {
  vec4 depth = texelFetch(media, mediumRow + 2 * four) * pathLength_, source = texelFetch(media, mediumRow + 2 * four + 1), result;
//@each j 4
  {
    int i = min(4 * four + {j}, NODES - 1);
    Real air = pathDepth(i, near_, far_);
    Real before = pathRadiance(i, near_), tau = pathTransmittance(i, near_), inside = pathInside(i, near_, far_);
    Real own = mediumRadiance(depth[{j}], air, before, inside, tau, source[{j}]);
    result[{j}] = decay(depth[{j}]) * (behind[{j}] - (before + inside)) + own;
  }
//@end
  return result;
}

//@slot targets
//@slot blend

void main() {
  prepareRay(gl_FragCoord.xy);
  Draw body = drawAt(uint(drawIndex));
  vec3 d = inBody(body, ray_), q = pointOnPlane(body);
  float start = -planeOf(body);  // the camera
  float end = endOfRay(body);
  vec2 chord;
  float inside;
  if (form == 0) {
    vec2 sums = texelFetch(thicknessSums, ivec2(gl_FragCoord.xy), 0).xy, bounds = texelFetch(thicknessBounds, ivec2(gl_FragCoord.xy), 0).xy;
    bool from = sums.y > 0.5;  // the camera is inside
    chord = vec2(from ? start : -bounds.x, bounds.y);
    inside = sums.x - (from ? sums.y * start : 0.0);
  } else {
    chord = form == 1 ? ellipsoidChord(q, d, formSize) : coneChord(q, d, formSize.x, formSize.y, formSize.z);
    chord = vec2(max(chord.x, start), min(chord.y, end));
    inside = chord.y - chord.x;
  }
  if (!(inside > 0.0)) discard;
  pathLength_ = inside * rayLength_;
  float range = max((planeOf(body) + chord.x) * rayLength_, 0.0);
  vec3 upThere;
  float height = heightAt(range, upThere);
  sunElevation_ = 0.0;
  near_ = airFromCamera(range);
  far_ = airBeyond(near_, range, height, dot(upThere, ray_) / rayLength_, (chord.y - chord.x) * rayLength_);
  blend();
}
