// A transparent surface on a line, each node by its own transmittance T. With radiances as seen from the camera:
//   L <- T L + (1 - T) L_path(r) + tau(r) (emission + reflection).   Source: PHYSICS section 2; Duvenhage 2006 section 5.3.2.
// What lies behind was told without the surface, air from the camera on included; of that air the part in front of the surface is not
// dimmed by it, hence the second term.
layout(binding = 18) uniform usamplerBuffer list;  // pixel, draw, triangle
//@use sim/render/surface/glsl/shading.glsl
//@use sim/render/media/glsl/listed_entry.glsl

Real throughAt(int i) { return transmittance(i); }
Real ownAt(int i) { return (1.0 - transmittance(i)) * pathRadiance(i, air_) + pathTransmittance(i, air_) * selfRadiance(i) + reflectedLight(i); }

void main() {
  int entry = listedEntry();
  uvec4 pane = texelFetch(list, entry);
  lookAt(pane.yz, vec2(pane.x & 0xffffu, pane.x >> 16) + 0.5);
//@each t TARGETS
  vec4 through{t}, own{t};
//@end
//@slot nodes
//@each t TARGETS
  storePassage(entry, {t}, through{t}, own{t});
//@end
}
