#pragma once
// Turns a detector channel into outputs: which spectral kernel a quantity needs and what its integral is multiplied by.
// Source: Duvenhage 2006 sections 4.5 and 4.7 (steps 6 and 7); focal-plane irradiance E = pi L tau_o / (4 F^2) cos^4 psi.
#include <optional>
#include <string>
#include <vector>

#include "sim/model/channel.hpp"
#include "sim/scene/camera.hpp"

namespace pitviper {

struct Gain {
  double volts = 0.0;
  bool perIrradiance = false;  ///< V/(W/m2) of focal-plane irradiance; otherwise V/W of pixel flux
};

/// What a channel's detector is, before a quantity is chosen.
struct Detector {
  std::string channel;
  Location where;
  Spectrum response;                          ///< dimensionless, zero outside its band
  Spectrum optics{1.0};                       ///< transmission of the camera's optics
  std::optional<Spectrum> quantumEfficiency;  ///< photoelectrons per photon
  std::optional<Gain> gain;
  Spectrum photopic;  ///< V(lambda)
};

struct QuantityInfo {
  std::string name;
  std::string unit;
  std::string meaning;
  bool probe = false;  ///< also for a probe (its own meaning there)
};

/// Every quantity a channel can be asked for.
const std::vector<QuantityInfo>& quantities();
std::vector<std::string> quantityNames();
std::vector<std::string> probeQuantityNames();

/// UserError where the quantity needs something the channel does not have (quantum efficiency, gain, exposure).
ChannelOutput makeOutput(const Detector& detector, const std::string& quantity, const Pinhole& pinhole, double exposure_s);
/// A probe's output: irradiance [W/m2], photon irradiance or illuminance on a plane.
ChannelOutput makeProbeOutput(const Detector& detector, const std::string& quantity);

}  // namespace pitviper
