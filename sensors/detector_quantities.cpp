// Quantities of a pixel behind the optics.
#include "sensors/quantity.hpp"

namespace pitviper {
namespace {

void flux(const Detector& d, const Collector& c, ChannelOutput& o) {
  o.perEtendue = o.behindOptics = true;
  // A constant transmission is a factor, not a kernel: flux and radiance then share their spectral integral.
  o.scale = o.onFilmScale = c.apertureArea_m2;
  o.onFilm = o.kernel;
  if (d.optics.isConstant()) o.scale *= d.optics(1.0);
  else o.kernel = o.kernel * d.optics;
}

/// What the film makes of its light, wherever that comes from.
void weigh(ChannelOutput& o, const Spectrum& by) {
  o.kernel = o.kernel * by;
  o.onFilm = o.onFilm * by;
}

void focalIrradiance(const Detector& d, const Collector& c, ChannelOutput& o) {
  flux(d, c, o);
  o.scale /= c.pixelArea_m2, o.onFilmScale /= c.pixelArea_m2;
}

void focalIlluminance(const Detector& d, const Collector& c, ChannelOutput& o) {
  o.kernel = photometric(d);
  focalIrradiance(d, c, o);
}

void exposure(const Detector& d, const Collector& c, ChannelOutput& o) {
  if (!(c.exposure_s > 0.0))
    throw UserError(d.where, "'" + o.quantity + "' needs an exposure time", "'exposure' of the camera or sensor, such as '2 ms'", "add 'exposure: 2 ms' to it");
  flux(d, c, o);
  o.perExposure = true;
}

void photons(const Detector& d, const Collector& c, ChannelOutput& o) {
  exposure(d, c, o);
  weigh(o, photonsPerJoule());
}

void electrons(const Detector& d, const Collector& c, ChannelOutput& o) {
  exposure(d, c, o);
  if (!d.quantumEfficiency)
    throw UserError(d.where, "'" + o.quantity + "' needs a quantum efficiency", "'quantum_efficiency' of the channel, a number or a spectrum",
                    "add 'quantum_efficiency: 0.8'");
  weigh(o, *d.quantumEfficiency * photonsPerJoule());
}

/// Photoelectrons, which the detector's stage makes counts of.
void counts(const Detector& d, const Collector& c, ChannelOutput& o) {
  if (!c.hasDetector)
    throw UserError(d.where, "'" + o.quantity + "' needs a detector", "a camera with 'stage: detector' among its 'stages'",
                    "add '- {stage: detector, full_well: 7e6}' under 'stages:'");
  electrons(d, c, o);
  o.detected = true;
}

/// By the counts where a detector makes some, else by the radiance at the aperture.
void apparentTemperature(const Detector& d, const Collector& c, ChannelOutput& o) {
  if (c.hasDetector) counts(d, c, o);
  o.asTemperature = true;
}

/// What the detector tells of its photoelectrons besides counts.
void signalToNoise(const Detector& d, const Collector& c, ChannelOutput& o) {
  counts(d, c, o);
  o.asSignalToNoise = true;
}

void saturated(const Detector& d, const Collector& c, ChannelOutput& o) {
  counts(d, c, o);
  o.asMark = true;
}

void display(const Detector& d, const Collector& c, ChannelOutput& o) {
  counts(d, c, o);
  o.asDisplay = true;
}

void volts(const Detector& d, const Collector& c, ChannelOutput& o) {
  if (!d.gain) throw UserError(d.where, "'volts' needs a gain", "'gain' of the channel in V/W or V/(W/m2)", "add 'gain: 2e6 V/W'");
  flux(d, c, o);
  const double factor = d.gain->volts / (d.gain->perIrradiance ? c.pixelArea_m2 : 1.0);
  o.scale *= factor, o.onFilmScale *= factor;
}

}  // namespace

std::vector<Quantity> detectorQuantities() {
  return {
      {"flux", "W", "pixel flux behind the optics", flux},
      {"focal_irradiance", "W/m2", "irradiance on the film, flux per pixel area", focalIrradiance},
      {"focal_illuminance", "lx", "illuminance on the film", focalIlluminance},
      {"exposure", "J", "flux times exposure time", exposure},
      {"photons", "photon", "photons on the pixel during the exposure", photons},
      {"electrons", "electron", "photoelectrons during the exposure (needs quantum_efficiency)", electrons},
      {"counts", "count", "what the detector's stage makes of the photoelectrons (needs quantum_efficiency, exposure and `stage: detector`)", counts},
      {"apparent_temperature", "K", "temperature of a black body that gives the same counts, or, without a detector's stage, the same radiance",
       apparentTemperature},
      {"snr", "1", "mean photoelectrons of light over the noise of a frame, without what is fixed (needs what counts need)", signalToNoise},
      {"saturated", "1",
       "why a pixel's count says nothing: 1 the well or the converter is full, 2 the converter's lowest code, 3 a bad pixel; else 0 (needs what counts need)",
       saturated},
      {"display", "code", "counts as 256 codes for a screen, by the detector's `agc`: for people, no measurements", display},
      {"volts", "V", "gain times flux or focal-plane irradiance (needs gain)", volts}};
}

}  // namespace pitviper
