#include "sensors/quantity.hpp"

#include "sim/radiometry/constants.hpp"

namespace pitviper {

Registry<Quantity>& quantities() {
  static Registry<Quantity> all = [] {
    Registry<Quantity> shipped("quantity", {});
    for (const auto& some : {apertureQuantities(), detectorQuantities()})
      for (const Quantity& q : some) shipped.add(q);
    return shipped;
  }();
  return all;
}

std::vector<std::string> quantityNames(bool ofProbe) {
  std::vector<std::string> names;
  for (const auto& q : quantities().all())
    if (q.probe || !ofProbe) names.push_back(q.name);
  return names;
}

ChannelOutput makeOutput(const Detector& d, const std::string& quantity, const Collector& collector) {
  const Quantity& q = *quantities().named(quantity);
  ChannelOutput o;
  o.channel = d.channel;
  o.quantity = q.name;
  o.unit = q.unit;
  o.where = d.where;
  o.kernel = d.response;
  o.bandLow_um = d.response.supportLow();
  o.bandHigh_um = d.response.supportHigh();
  o.curves = std::make_shared<const ChannelCurves>(ChannelCurves{d.response, d.optics, d.quantumEfficiency});
  q.form(d, collector, o);
  return o;
}

Spectrum photonsPerJoule() {
  return Spectrum(Spectrum::Table{{kShortestWavelength_um, kLongestWavelength_um},
                                  {kPhotonsPerJoulePerUm * kShortestWavelength_um, kPhotonsPerJoulePerUm * kLongestWavelength_um},
                                  Outside::Error,
                                  "photons per joule"});
}

Spectrum photometric(const Detector& d) { return d.photopic() * d.response * kLuminousEfficacy; }

}  // namespace pitviper
