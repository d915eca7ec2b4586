// One transparent surface over the spectral image, each node by its own transmittance T. With radiances as seen from the camera:
//   L <- T L + (1 - T) L_path(r) + tau(r) (emission + reflection).   Source: PHYSICS section 2; Duvenhage 2006 section 5.3.2.
// What lies behind was drawn without the surface, air from the camera on included; of that air the part in front of the surface is not
// dimmed by it, hence the second term.
flat in uvec2 seen;
//@use sim/render/glsl/shading.glsl
//@slot ground

// One thing of its own.
int layersHere() { return 1; }
void prepareLayer(int k) {}

Real blended(Real behind, int i) {
  Real t = transmittance(i);
  Real own = (1.0 - t) * pathRadiance(i, air_) + pathTransmittance(i, air_) * selfRadiance(i) + reflectedLight(i);
  return t * behind + own;
}

//@slot blend

void main() {
  lookAt(seen, gl_FragCoord.xy);
  if (hiddenByGround(range_)) discard;
  blend();
}
