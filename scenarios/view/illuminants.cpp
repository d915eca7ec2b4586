#include "scenarios/view/illuminants.hpp"

#include "scenarios/reader/yaml_tree.hpp"
#include "scenarios/view/library_lookup.hpp"

namespace pitviper {
namespace {

/// From a lamp of a scenario.
constexpr double kLampDistance_m = 10.0;
/// Solid angle of the sun [sr]: 0.267 degrees of radius. Source: IAU 2015 resolution B3 at 1 au.
constexpr double kSun_sr = 6.794e-5;

/// 1 W/(m2 um) times a relative spectrum of the library; none where that says nothing.
Spectrum named(const std::string& words, const Libraries& libraries) {
  return spectraIn(".", libraries).read(parseYaml("{product: [\"1 W/(m2 um)\", " + words + "]}", "light"), "W/(m2 um)", "light", Outside::Zero);
}

}  // namespace

std::vector<Illuminant> illuminantsOf(const Libraries& libraries, const Simulation* scenario) {
  std::vector<Illuminant> all;
  if (scenario && scenario->sun) all.push_back({"sun of the scenario", scenario->sun->irradiance});
  all.push_back({"sun, 5772 K", Spectrum(Spectrum::BlackBody{5772.0, kSun_sr})});
  all.push_back({"D65", named("cie_d65", libraries)});
  all.push_back({"A", named("cie_a", libraries)});
  all.push_back({"sodium", named("sodium_low_pressure", libraries)});
  if (scenario)
    for (const PointLight& l : scenario->lights)
      if (l.lamp < 0) all.push_back({"lamp " + l.name, l.intensity * (1.0 / (kLampDistance_m * kLampDistance_m))});
  return all;
}

}  // namespace pitviper
