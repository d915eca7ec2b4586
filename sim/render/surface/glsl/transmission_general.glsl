// Transmittance by view angle, with its modifier.
layout(binding = 4) uniform samplerBuffer transmittances;
Real transmittanceUnmodified(int i) {
  int at = material_.transmission.y + viewEntry_ * NODES + i;
  return mix(texelFetch(transmittances, at).x, texelFetch(transmittances, material_.counts.z > 1u ? at + NODES : at).x, viewMix_);
}
Real transmittance(int i) { return transmissionModifier_ * transmittanceUnmodified(i); }
// What the modifier keeps back.
Real transmittanceLost(int i) { return (1.0 - transmissionModifier_) * transmittanceUnmodified(i); }
