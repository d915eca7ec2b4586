#pragma once
// Fingerprints of what a scenario is made of: whole tables, whole motions, all vertices.
#include "sim/model/simulation.hpp"
#include "sim/parameters/fingerprint.hpp"

namespace pitviper {

void addTo(Fingerprint& f, const Spectrum& spectrum);
void addTo(Fingerprint& f, const Motion& motion);
void addTo(Fingerprint& f, const Material& material);
/// Everything that a picture of it depends on but for cameras and probes.
void addTo(Fingerprint& f, const Simulation& simulation);
void addTo(Fingerprint& f, const Camera& camera);
void addTo(Fingerprint& f, const Probe& probe);

}  // namespace pitviper
