// Quantities of the light that arrives at the aperture, or on a probe's plane.
#include "sensors/quantity.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

void radiance(const Detector&, const Collector&, ChannelOutput&) {}

void radiancePerUm(const Detector& d, const Collector&, ChannelOutput& o) {
  const double integral = d.response.integral(o.bandLow_um, o.bandHigh_um);
  o.scale = integral > 0.0 ? 1.0 / integral : 0.0;
}

void photonRadiance(const Detector& d, const Collector&, ChannelOutput& o) { o.kernel = d.response * photonsPerJoule(); }

void luminance(const Detector& d, const Collector&, ChannelOutput& o) { o.kernel = photometric(d); }

void tristimulus(const Detector& d, const Collector&, ChannelOutput& o) { o.kernel = d.response * kLuminousEfficacy; }

using Form = void (*)(const Detector&, const Collector&, ChannelOutput&);

/// On the aperture from the pixel's field, or on a plane from all of the half space before it.
template <Form form>
void onPlane(const Detector& d, const Collector& c, ChannelOutput& o) {
  form(d, c, o);
  o.perEtendue = true;
}

}  // namespace

std::vector<Quantity> apertureQuantities() {
  return {{"radiance", "W/(m2 sr)", "in-band radiance at the aperture, integral of S L", radiance},
          {"radiance_per_um", "W/(m2 sr um)", "the same divided by the integral of S", radiancePerUm},
          {"photon_radiance", "photon/(s m2 sr)", "in-band photon radiance at the aperture", photonRadiance},
          {"luminance", "cd/m2", "683 lm/W times the integral of S V L", luminance},
          {"tristimulus", "cd/m2", "683 lm/W times the integral of S L: X, Y or Z where S is one of the CIE 1931 functions (`eye: true` is all three)",
           tristimulus},
          {"irradiance", "W/m2", "irradiance on the aperture from the pixel's field; of a probe: on its plane", onPlane<radiance>, true},
          {"photon_irradiance", "photon/(s m2)", "the same in photons", onPlane<photonRadiance>, true},
          {"illuminance", "lx", "the same with V(lambda)", onPlane<luminance>, true}};
}

}  // namespace pitviper
