// The luminance of clear skies over the dome against the standard that daylight engineers hold theirs against.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "sim/radiance/node_sum.hpp"
#include "sim/radiance/radiance.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Luminance over that of the zenith: CIE S 011/E:2003 (ISO 15469), (1 + a exp(b/cos Z)) (1 + c (exp(d chi) - exp(d pi/2)) + e cos^2 chi) over itself at Z = 0.
double cieSky(const std::array<double, 5>& type, double zenith, double sunZenith, double chi) {
  const auto& [a, b, c, d, e] = type;
  const auto graded = [&](double z) { return 1.0 + a * std::exp(b / std::cos(z)); };
  const auto turned = [&](double x) { return 1.0 + c * (std::exp(d * x) - std::exp(d * kPi / 2.0)) + e * std::cos(x) * std::cos(x); };
  return graded(zenith) * turned(chi) / (graded(0.0) * turned(sunZenith));
}

// Rationale: how light that air scatters, and scatters again, goes over the sky. Expected: of the standard's clear skies the one of clear air (12) is that of
// our air of 50 km visibility, that of turbid air (13) ours of 23 km, within the scatter of the two, rms 0.12 and 0.14 of the logarithm (molecules alone, which
// no place has, brighten horizons by twice as much).
TEST(SkyShape, IsThatOfCieClearSkies) {
  constexpr std::array<double, 5> kClear{-1.0, -0.32, 10.0, -3.0, 0.45}, kTurbid{-1.0, -0.32, 16.0, -3.0, 0.3};
  for (const double sun_deg : {30.0, 50.0}) {
    double squares[2] = {}, apart = 0.0, worst[2] = {};
    int count = 0;
    std::vector<std::vector<double>> found;
    for (const char* air : {"{library: hazy_us76, visibility: 50 km}", "hazy_us76"}) {
      const Simulation sim =
          scene(std::string("atmosphere: ") + air + "\nsun: {azimuth: 0 deg, elevation: " + print("%g", sun_deg) +
                " deg, irradiance: solar_e490}\nground: {material: green_grass, temperature: 290 K}\n"
                "cameras: [{name: e, film: {width: 3, height: 3}, field_of_view: 1 deg, aperture: 5 mm, position: [0 m, 0 m, 2 m], heading: 0 "
                "deg, pitch: 10 deg, channels: [{name: b, response: {band: [0.5 um, 0.6 um]}}]}]\n");
      Terms terms = termsOf(sim);
      terms.streams = 16;
      const std::vector<SpectralNode> nodes{nodeAt(sim, 0.555)};
      const NodeSpectra spectra(sim, nodes, terms);
      const auto legs = SunLegs::of(sim.air, sim.sun->toSun.z, sim.frame.earthRadius_m());
      const WorldState state = advance(sim, 0.0);
      NodeSum sum(spectra);
      const auto radiance = [&](double zenith, double azimuth) {
        const glm::dvec3 direction(std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth), std::cos(zenith));
        sum.begin();
        radianceAlong({sim, terms, legs.get(), state, {}}, {{0, 0, 2.0}, direction, {}, 0.0}, sum);
        return std::pair(sum.radiance()[0], std::acos(glm::clamp(glm::dot(direction, sim.sun->toSun), -1.0, 1.0)));
      };
      const double top = radiance(0.0, 0.0).first, sunZenith = (90.0 - sun_deg) * kPi / 180.0;
      auto& own = found.emplace_back();
      for (double z = 5.0; z <= 80.0; z += 15.0)
        for (double a = 0.0; a <= 180.0; a += 30.0) {
          const auto [seen, chi] = radiance(z * kPi / 180.0, a * kPi / 180.0);
          if (chi < 15.0 * kPi / 180.0) continue;  // the aureole is that of the aerosol at hand
          own.push_back(seen / top);
          const std::size_t k = found.size() - 1;
          const double type[2] = {cieSky(kClear, z * kPi / 180.0, sunZenith, chi), cieSky(kTurbid, z * kPi / 180.0, sunZenith, chi)};
          const double off = std::log(own.back() / type[k]);
          squares[k] += off * off, worst[k] = std::max(worst[k], std::abs(off));
          if (k == 0) apart += std::pow(std::log(type[0] / type[1]), 2), ++count;
        }
    }
    const double rms[2] = {std::sqrt(squares[0] / count), std::sqrt(squares[1] / count)};
    std::printf("sun %g: worst %.3f and %.3f, types apart rms %.3f\n", sun_deg, worst[0], worst[1], std::sqrt(apart / count));
    bound("clear sky over its zenith, sun at " + print("%g", sun_deg) + " deg, against CIE 12, rms of the logarithm", rms[0], 0.14, "scatter of CIE 12 and 13");
    bound("hazy sky over its zenith, sun at " + print("%g", sun_deg) + " deg, against CIE 13, rms of the logarithm", rms[1], 0.10, "scatter of CIE 12 and 13");
  }
}

}  // namespace
}  // namespace pitviper::test
