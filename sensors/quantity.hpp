#pragma once
// What a channel's light is told as: which spectral kernel a quantity needs and what its integral is multiplied by. One row registers a quantity.
// Source: Duvenhage 2006 sections 4.5 and 4.7 (steps 6 and 7); focal-plane irradiance E = pi L tau_o / (4 F^2) cos^4 psi.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/model/channel.hpp"
#include "sim/parameters/registry.hpp"
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
  std::function<Spectrum()> photopic;  ///< V(lambda), where it is asked for
};

/// What stands before it: nothing (a probe's plane), or a camera.
struct Collector {
  double apertureArea_m2 = 0.0, pixelArea_m2 = 0.0, exposure_s = 0.0;
  bool hasDetector = false;  ///< a stage makes counts
  Collector() = default;
  Collector(const Pinhole& p, double exposure) : apertureArea_m2(p.apertureArea_m2()), pixelArea_m2(p.pitchX_m * p.pitchY_m), exposure_s(exposure) {}
};

struct Quantity {
  std::string name;
  std::string unit;
  std::string meaning;
  /// Changes the kernel and factors of an output that has the channel's response for a kernel and a factor of 1. UserError where the channel lacks what
  /// it takes.
  std::function<void(const Detector&, const Collector&, ChannelOutput&)> form;
  bool probe = false;  ///< also of a probe: it takes no collector
};

Registry<Quantity>& quantities();
/// Of a camera, or of a probe.
std::vector<std::string> quantityNames(bool ofProbe);
/// `quantity`: one of these.
ChannelOutput makeOutput(const Detector& detector, const std::string& quantity, const Collector& collector);

/// In-band figures of the light that arrives, and of the detector behind the optics.
std::vector<Quantity> apertureQuantities();
std::vector<Quantity> detectorQuantities();
/// k(lambda) = lambda / (h c) [photons/J], linear in wavelength.
Spectrum photonsPerJoule();
/// 683 lm/W V(lambda) times the response.
Spectrum photometric(const Detector& detector);

}  // namespace pitviper
