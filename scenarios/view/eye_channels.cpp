#include "scenarios/view/eye_channels.hpp"

#include <cmath>
#include <functional>

#include "scenarios/view/band_rule.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Off by no more than this in X, Y or Z: a hundredth of what an eye may tell apart.
constexpr double kOff = 1e-5;

/// X, Y, Z of light x f, which bends at knots.
glm::dvec3 seenLight(const Spectrum& light, const std::vector<SphereChannel>& eye, const std::vector<double>& knots_um,
                     const std::function<double(double)>& f) {
  std::vector<Spectrum> weights;
  for (std::size_t k = 0; k < 3; ++k) weights.push_back(eye.at(k).kernel * light);
  const BandRule rule = bandRule(
      weights, knots_um, [](double) { return kLongestWavelength_um; }, {{{0, 1, 2}, 1, [&](double w, std::vector<double>& values) { values[0] = f(w); }}},
      kOff);
  glm::dvec3 xyz(0.0);
  for (std::size_t p = 0; p < rule.wavelength_um.size(); ++p) {
    const double value = f(rule.wavelength_um[p]);
    for (int k = 0; k < 3; ++k) xyz[k] += rule.weight[static_cast<std::size_t>(k)][p] * value;
  }
  return xyz;
}

/// Of the light itself.
glm::dvec3 lightOf(const Spectrum& light, const std::vector<SphereChannel>& eye) {
  const glm::dvec3 xyz = seenLight(light, eye, {}, [](double) { return 1.0; });
  if (!(xyz.y > 0.0)) throw UserError({}, "a light that an eye does not see", "light between 0.36 and 0.83 um", "take another");
  return xyz;
}

}  // namespace

std::vector<SphereChannel> eyeChannels(const Libraries& libraries) {
  const Simulation sim = readScenarioText(
      "cameras: [{name: eye, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 5 mm, position: [1 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], eye: "
      "true}]\n",
      "eye", ".", {}, libraries);
  return sphereChannels(sim.cameras.at(0).outputs);
}

glm::dvec3 whiteOf(const Spectrum& light, const std::vector<SphereChannel>& eye) {
  const glm::dvec3 xyz = lightOf(light, eye);
  return xyz / xyz.y;
}

glm::dvec3 xyzOf(const Material& material, const Spectrum& light, const std::vector<SphereChannel>& eye) {
  if (material.medium) throw UserError(material.where, "the colour of '" + material.name + "', which is a medium", "a surface", "take another material");
  const double low = eye.at(1).kernel.supportLow(), high = eye.at(1).kernel.supportHigh();
  if (low < material.validLow_um() || high > material.validHigh_um())
    throw UserError(material.where,
                    print("'%s' has no data that an eye needs (it covers %g to %g um)", material.name.c_str(), material.validLow_um(), material.validHigh_um()),
                    print("data from %g to %g um", low, high), "extend its spectra, or write 'outside: hold' in them");
  std::vector<double> knots;
  for (const auto& r : material.reflections) {
    const auto own = r->knots_um();
    knots.insert(knots.end(), own.begin(), own.end());
  }
  const glm::dvec3 from(std::sqrt(0.5), 0.0, std::sqrt(0.5)), seen(0.0, 0.0, 1.0);
  return seenLight(light, eye, knots,
                   [&](double w) {
                     double sum = 0.0;
                     for (const auto& r : material.reflections) sum += r->brdf(w, from, seen);
                     return kPi * sum;
                   }) /
         lightOf(light, eye).y;
}

glm::dvec3 labOf(const glm::dvec3& xyz, const glm::dvec3& white) {
  const auto f = [](double t) {
    constexpr double kKnee = 6.0 / 29.0;
    return t > kKnee * kKnee * kKnee ? std::cbrt(t) : t / (3.0 * kKnee * kKnee) + 4.0 / 29.0;
  };
  const double x = f(xyz.x / white.x), y = f(xyz.y / white.y), z = f(xyz.z / white.z);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

double colourDifference(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& white) { return glm::length(labOf(a, white) - labOf(b, white)); }

}  // namespace pitviper
