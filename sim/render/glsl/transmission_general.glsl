// Transmittance by view angle, with its modifier.
layout(binding = 4) uniform samplerBuffer transmittances;
Real transmittance(int i) {
  int at = material_.transmission.y + viewEntry_ * NODES + i;
  return transmissionModifier_ * mix(texelFetch(transmittances, at).x, texelFetch(transmittances, material_.counts.z > 1u ? at + NODES : at).x, viewMix_);
}
