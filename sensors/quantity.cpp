#include "sensors/quantity.hpp"

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// k(lambda) = lambda / (h c) [photons/J], linear in wavelength.
Spectrum photonsPerJoule() {
  return Spectrum(Spectrum::Table{{kShortestWavelength_um, kLongestWavelength_um},
                                  {kPhotonsPerJoulePerUm * kShortestWavelength_um, kPhotonsPerJoulePerUm * kLongestWavelength_um},
                                  Outside::Error,
                                  "photons per joule"});
}

ChannelOutput start(const Detector& d, const std::string& quantity) {
  ChannelOutput o;
  o.channel = d.channel;
  o.quantity = quantity;
  o.where = d.where;
  o.kernel = d.response;
  o.bandLow_um = d.response.supportLow();
  o.bandHigh_um = d.response.supportHigh();
  for (const auto& q : quantities())
    if (q.name == quantity) o.unit = q.unit;
  return o;
}

Spectrum photometric(const Detector& d) { return d.photopic * d.response * kLuminousEfficacy; }

void requireExposure(const Detector& d, const std::string& quantity, double exposure_s) {
  if (!(exposure_s > 0.0))
    throw UserError(d.where, "'" + quantity + "' needs an exposure time", "'exposure' of the camera or sensor, such as '2 ms'", "add 'exposure: 2 ms' to it");
}

}  // namespace

const std::vector<QuantityInfo>& quantities() {
  static const std::vector<QuantityInfo> all = {
      {"radiance", "W/(m2 sr)", "in-band radiance at the aperture, integral of S L"},
      {"radiance_per_um", "W/(m2 sr um)", "the same divided by the integral of S"},
      {"photon_radiance", "photon/(s m2 sr)", "in-band photon radiance at the aperture"},
      {"luminance", "cd/m2", "683 lm/W times the integral of S V L"},
      {"irradiance", "W/m2", "irradiance on the aperture from the pixel's field; of a probe: on its plane", true},
      {"photon_irradiance", "photon/(s m2)", "the same in photons", true},
      {"illuminance", "lx", "the same with V(lambda)", true},
      {"flux", "W", "pixel flux behind the optics"},
      {"focal_irradiance", "W/m2", "irradiance on the film, flux per pixel area"},
      {"focal_illuminance", "lx", "illuminance on the film"},
      {"exposure", "J", "flux times exposure time"},
      {"photons", "photon", "photons on the pixel during the exposure"},
      {"electrons", "electron", "photoelectrons during the exposure (needs quantum_efficiency)"},
      {"volts", "V", "gain times flux or focal-plane irradiance (needs gain)"},
  };
  return all;
}

std::vector<std::string> quantityNames() {
  std::vector<std::string> names;
  for (const auto& q : quantities()) names.push_back(q.name);
  return names;
}

std::vector<std::string> probeQuantityNames() {
  std::vector<std::string> names;
  for (const auto& q : quantities())
    if (q.probe) names.push_back(q.name);
  return names;
}

ChannelOutput makeOutput(const Detector& d, const std::string& quantity, const Pinhole& pinhole, double exposure_s) {
  ChannelOutput o = start(d, quantity);
  const double aperture = pinhole.apertureArea_m2(), pixel = pinhole.pitchX_m * pinhole.pitchY_m;
  if (quantity == "radiance") return o;
  if (quantity == "radiance_per_um") {
    const double integral = d.response.integral(o.bandLow_um, o.bandHigh_um);
    o.scale = integral > 0.0 ? 1.0 / integral : 0.0;
  } else if (quantity == "photon_radiance") {
    o.kernel = d.response * photonsPerJoule();
  } else if (quantity == "luminance") {
    o.kernel = photometric(d);
  } else if (quantity == "irradiance" || quantity == "photon_irradiance" || quantity == "illuminance") {
    o = makeProbeOutput(d, quantity);
  } else {
    o.perEtendue = true;
    // A constant transmission is a factor, not a kernel: flux and radiance then share their spectral integral.
    const double grey = d.optics.isConstant() ? d.optics(1.0) : 1.0;
    o.scale = aperture * grey;
    o.kernel = d.optics.isConstant() ? d.response : d.response * d.optics;
    o.perExposure = quantity == "exposure" || quantity == "photons" || quantity == "electrons";
    if (o.perExposure) requireExposure(d, quantity, exposure_s);
    if (quantity == "focal_irradiance") {
      o.scale /= pixel;
    } else if (quantity == "focal_illuminance") {
      o.scale /= pixel;
      o.kernel = d.optics.isConstant() ? photometric(d) : photometric(d) * d.optics;
    } else if (quantity == "photons") {
      o.kernel = o.kernel * photonsPerJoule();
    } else if (quantity == "electrons") {
      if (!d.quantumEfficiency)
        throw UserError(d.where, "'electrons' needs a quantum efficiency", "'quantum_efficiency' of the channel, a number or a spectrum",
                        "add 'quantum_efficiency: 0.8'");
      o.kernel = o.kernel * *d.quantumEfficiency * photonsPerJoule();
    } else if (quantity == "volts") {
      if (!d.gain) throw UserError(d.where, "'volts' needs a gain", "'gain' of the channel in V/W or V/(W/m2)", "add 'gain: 2e6 V/W'");
      o.scale *= d.gain->volts / (d.gain->perIrradiance ? pixel : 1.0);
    }
  }
  return o;
}

ChannelOutput makeProbeOutput(const Detector& d, const std::string& quantity) {
  ChannelOutput o = start(d, quantity);
  o.perEtendue = true;
  if (quantity == "photon_irradiance") o.kernel = d.response * photonsPerJoule();
  if (quantity == "illuminance") o.kernel = photometric(d);
  return o;
}

}  // namespace pitviper
