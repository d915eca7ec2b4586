// Where a line enters and leaves a medium of a true form, as far as something solid or the ground lets it.
layout(early_fragment_tests) in;
//@use sim/radiometry/glsl/chord.glsl
//@use sim/render/geometry/glsl/volume_ray.glsl
//@use sim/render/geometry/glsl/hit_list.glsl
uniform int drawIndex;
uniform int form;  // 1 ellipsoid, 2 cone
uniform vec3 formSize;

void main() {
  prepareRay(gl_FragCoord.xy);
  Draw body = drawAt(uint(drawIndex));
  vec3 d = inBody(body, ray_), q = pointOnPlane(body);
  vec2 chord = form == 1 ? ellipsoidChord(q, d, formSize) : coneChord(q, d, formSize.x, formSize.y, formSize.z);
  chord = vec2(max(chord.x, -planeOf(body)), min(chord.y, endOfRay(body, ivec2(gl_FragCoord.xy))));
  if (chord.y > chord.x) addHit(kMedium, uint(drawIndex), uvec3(floatBitsToUint(chord), 0u));
}
