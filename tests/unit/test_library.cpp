// Library materials that are seen through, against the figures they were made from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::shared_ptr<const Material> libraryMaterial(const std::string& name, bool medium) {
  const Simulation sim =
      scene("entities: [{name: b, shape: {model: " + std::string(medium ? "sphere, radius: 1 m" : "plate, width: 1 m, height: 1 m") + "}, material: " + name +
            ", temperature: 300 K}]\n"
            "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 2 deg, aperture: 20 mm, heading: 0 deg, channels: [{name: a, "
            "response: {band: [3 um, 5 um]}}]}]\n");
  for (const auto& m : sim.materials)
    if (m->name == name) return m;
  ADD_FAILURE() << name;
  return nullptr;
}

/// Mean over [low, high], weighted with Planck's law at a temperature, or not at all (0 K).
template <class F>
double bandMean(double low_um, double high_um, double temperature_K, const F& f) {
  double sum = 0.0, weights = 0.0;
  constexpr int kSteps = 4000;
  for (int i = 0; i < kSteps; ++i) {
    const double l = low_um + (high_um - low_um) * (i + 0.5) / kSteps;
    const double weight = temperature_K > 0.0 ? std::pow(l, -5.0) / std::expm1(14387.76877 / (l * temperature_K)) : 1.0;
    sum += weight * f(l);
    weights += weight;
  }
  return sum / weights;
}

// Rationale: a gas in the library stands for tables of a band model. Expected: their emissivity, band means within a half per cent, single
// wavelengths within 0.03, at the path the coefficient is made for.
TEST(Library, GasesEmitAsTheBandModel) {
  struct Mean {
    const char* name;
    double temperature_K, path_m, low_um, high_um, emissivity;
  };
  for (const Mean& m : {Mean{"jet_exhaust", 850, 1.0, 3.6, 4.9, 0.2643}, Mean{"jet_exhaust", 850, 1.0, 8, 12, 0.0575},
                        Mean{"jet_exhaust", 850, 1.0, 2.5, 3, 0.3242}, Mean{"jet_exhaust_mixed", 500, 2.5, 3.6, 4.9, 0.2141},
                        Mean{"jet_exhaust_mixed", 500, 2.5, 8, 12, 0.0145}, Mean{"afterburner_plume", 1800, 1.0, 3.6, 4.9, 0.3954},
                        Mean{"afterburner_plume", 1800, 1.0, 8, 12, 0.3356}, Mean{"afterburner_plume", 1800, 1.0, 2.5, 3, 0.4601}}) {
    const auto gas = libraryMaterial(m.name, true);
    const double mean = bandMean(m.low_um, m.high_um, m.temperature_K, [&](double l) { return -std::expm1(-gas->medium->absorption_per_m(l) * m.path_m); });
    figure(std::string(m.name) + ", emissivity, " + std::to_string(m.low_um).substr(0, 3) + "-" + std::to_string(m.high_um).substr(0, 4) + " um", mean,
           m.emissivity, 0.005, "RADCAL narrow bands, Planck mean");
  }
  struct Point {
    const char* name;
    double wavelength_um, path_m, emissivity;
  };
  for (const Point& p :
       {Point{"afterburner_plume", 4.49438, 1.0, 1.0}, Point{"afterburner_plume", 2.73973, 1.0, 0.69427}, Point{"afterburner_plume", 12.04819, 1.0, 0.51115},
        Point{"afterburner_plume", 9.61538, 1.0, 0.28299}, Point{"afterburner_plume", 3.96040, 1.0, 0.00760}}) {
    const auto gas = libraryMaterial(p.name, true);
    EXPECT_NEAR(-std::expm1(-gas->medium->absorption_per_m(p.wavelength_um) * p.path_m), p.emissivity, 0.03) << p.name << " at " << p.wavelength_um;
  }
  for (const char* name : {"jet_exhaust", "jet_exhaust_mixed", "afterburner_plume"})
    EXPECT_EQ(bandMean(0.3, 1.5, 0, [gas = libraryMaterial(name, true)](double l) { return gas->medium->absorption_per_m(l); }), 0.0) << name;
}

// 7.5 m2/g at 0.55 um (Bond and Bergstrom 2006), as 1/wavelength, 0.1 g/m3.
TEST(Library, SmokeAbsorbsAsItsSoot) {
  const auto smoke = libraryMaterial("oil_smoke", true);
  for (double l : {0.3, 0.55, 1.06, 4.0, 10.6, 15.0})
    figure("oil_smoke, absorption at " + std::to_string(l).substr(0, 4) + " um [1/m]", smoke->medium->absorption_per_m(l), 0.1 * 7.5 * 0.55 / l, 0.006,
           "mass absorption x 0.1 g/m3; linear between rows");
}

/// Both faces of a slab of index n and internal transmittance a, at normal view, all reflections summed: T and R.
std::pair<double, double> slab(double n, double a) {
  const double r = std::pow((n - 1.0) / (n + 1.0), 2);
  const double t = (1.0 - r) * (1.0 - r) * a / (1.0 - r * r * a * a);
  return {t, r * (1.0 + a * t)};
}

// Rationale: a window is a table made from n, k and a thickness. Expected: the closed form of a slab at normal view, with n and absorption
// coefficient in the middle of a band in which both change little.
TEST(Library, WindowsTransmitAsTheirSlab) {
  struct Band {
    const char* name;
    double low_um, high_um, n, absorption_per_m, thickness_m, tolerance;
  };
  for (const Band& b : {Band{"acrylic_canopy", 0.45, 0.75, 1.486, 5.2, 8e-3, 0.005},        // k 2.4e-7 at 0.58 um
                        Band{"acrylic_canopy", 0.77, 0.85, 1.478, 4.2, 8e-3, 0.01},         // k 2.7e-7 at 0.81 um
                        Band{"sapphire_dome", 0.45, 0.75, 1.769, 0.0, 3e-3, 0.005},         // Malitson at 0.58 um
                        Band{"sapphire_dome", 3.6, 4.4, 1.675, 4.7, 3e-3, 0.005},           // 0.047 /cm at 4 um
                        Band{"zinc_sulphide_window", 3.6, 4.9, 2.251, 0.4, 6e-3, 0.005},    // 0.004 /cm
                        Band{"zinc_sulphide_window", 10.4, 10.8, 2.190, 20.0, 6e-3, 0.02},  // 0.2 /cm at 10.6 um
                        Band{"germanium_window", 3.6, 4.9, 4.020, 0.0, 4e-3, 0.01},         // Burnett at 4.25 um
                        Band{"germanium_window", 9.9, 10.5, 4.003, 2.0, 4e-3, 0.01},        // k 1.6e-6 at 10.2 um
                        Band{"window_glass", 0.45, 0.6, 1.526, 4.8, 4e-3, 0.01},            // k 2e-7 at 0.53 um
                        Band{"window_glass", 3.6, 4.0, 1.467, 345.0, 4e-3, 0.03}}) {        // k 1.04e-4 at 3.8 um
    const auto pane = libraryMaterial(b.name, false);
    const auto [t, r] = slab(b.n, std::exp(-b.absorption_per_m * b.thickness_m));
    const std::string what = std::string(b.name) + ", " + std::to_string(b.low_um).substr(0, 4) + "-" + std::to_string(b.high_um).substr(0, 4) + " um, ";
    figure(what + "transmittance", bandMean(b.low_um, b.high_um, 0, [&](double l) { return pane->transmittance(l, 0.0); }), t, b.tolerance,
           "Fresnel slab, n and k in the band's middle");
    figure(what + "reflectance", bandMean(b.low_um, b.high_um, 0, [&](double l) { return pane->reflectance(l, 0.0); }), r, 0.04,
           "Fresnel slab; few wavelengths in the table");
  }
}

// Both polarisations through a slab near Brewster's angle, where they differ most.
TEST(Library, WindowsAtAnAngle) {
  const double n = 1.486, cosine = std::cos(60.0 * kPi / 180.0), inside = std::sqrt(1.0 - 0.75 / (n * n));
  const double a = std::exp(-5.2 * 8e-3 / inside);
  double t = 0.0, r = 0.0;
  for (double f : {(cosine - n * inside) / (cosine + n * inside), (n * cosine - inside) / (n * cosine + inside)}) {
    const double face = f * f, through = (1.0 - face) * (1.0 - face) * a / (1.0 - face * face * a * a);
    t += 0.5 * through;
    r += 0.5 * face * (1.0 + a * through);
  }
  const auto pane = libraryMaterial("acrylic_canopy", false);
  figure("acrylic_canopy at 60 deg, 0.58 um, transmittance", pane->transmittance(0.58, kPi / 3.0), t, 0.01, "Fresnel slab, both polarisations");
  figure("acrylic_canopy at 60 deg, 0.58 um, reflectance", pane->reflectance(0.58, kPi / 3.0), r, 0.06, "Fresnel slab; lowered where energy would not balance");
  EXPECT_LT(std::max(bandMean(3.0, 5.0, 0, [&](double l) { return pane->transmittance(l, 0.0); }), pane->transmittance(10.0, 0.0)), 0.002) << "opaque";
  EXPECT_GT(pane->emissivity(10.0, 0.0), 0.94);
}

}  // namespace
}  // namespace pitviper::test
