// Angular reflection end to end, scenario to calibrated pixel, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0;

/// A plate that faces +x, seen from 10 m at an angle from its normal (in the horizontal plane, north positive), by 33 x 33 pixels.
std::string plateSeenAt(double view_deg) {
  return "entities: [{name: p, shape: {model: plate, width: 40 m, height: 40 m}, material: m, temperature: 0 K}]\n"
         "cameras: [{name: c, film: {width: 33, height: 33}, field_of_view: 0.2 deg, aperture: 20 mm, position: [" +
         std::to_string(10.0 * std::cos(view_deg * kDegree)) + " m, " + std::to_string(10.0 * std::sin(view_deg * kDegree)) +
         " m, 0 m], look_at: [0 m, 0 m, 0 m], channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n";
}
double middlePixel(const std::string& yaml) {
  const Frame f = renderFrame(scene(yaml));
  return at(layer(f, "mw.radiance"), f, 16, 16);
}

// L = E cos(theta_i) rho (n + 2)/(2 pi) cos^n(alpha) x 2 um, alpha between the view and the mirrored sun.
TEST(Reflection, PhongUnderTheSun) {
  for (double n : {1.0, 30.0, 2000.0})
    for (const auto& [sun, view] : {std::pair{0.0, 0.0}, {20.0, 0.0}, {60.0, 0.0}, {40.0, -40.0}, {40.0, -38.5}, {75.0, -70.0}, {-30.0, 45.0}, {50.0, 50.0}}) {
      const double alpha = std::abs(sun + view) * kDegree, lobe = std::pow(std::cos(alpha), n);
      if (std::cos(alpha) <= 0.0 || lobe < 1e-20) continue;
      const double got = middlePixel("materials: {m: {components: [{reflection: phong, reflectance: 0.6, exponent: " + std::to_string(n) +
                                     "}]}}\n"
                                     "sun: {azimuth: " +
                                     std::to_string(90.0 - sun) + " deg, elevation: 0 deg, irradiance: 100 W/(m2 um)}\n" + plateSeenAt(view));
      figure("Phong, n = " + std::to_string(static_cast<int>(n)) + ", sun at " + std::to_string(static_cast<int>(sun)) + ", seen at " +
                 std::to_string(view).substr(0, 5) + " deg [W/(m2 sr)]",
             got, 100.0 * std::cos(sun * kDegree) * 0.6 * (n + 2.0) / (2.0 * kPi) * lobe * 2.0, 2e-5,
             "E cos rho (n + 2)/(2 pi) cos^n; camera placed to 1e-7 rad, n tan(alpha) of that");
    }
}

// L = f I cos(theta_i)/d^2 x 2 um; light at 5 m, cos = 0.6, so that the angles are acos(0.6) or, half and difference, a half of it.
TEST(Reflection, TableUnderAPointLight) {
  const double incidence = std::acos(0.6), irradiance = 50.0 * 0.6 / 25.0 * 2.0;
  const std::string lamp = "lights: [{name: lamp, intensity: 50 W/(sr um), visible: false, position: [3 m, 4 m, 0 m]}]\n";
  for (const auto& [name, angle] :
       {std::pair<std::string, double>{"incidence", incidence}, {"specular", incidence}, {"half", 0.5 * incidence}, {"difference", 0.5 * incidence}}) {
    const double step = 30.0 * kDegree, x = angle / step;
    const double row[] = {0.30, 0.20, 0.12, 0.02};
    const int i = static_cast<int>(x);
    const double f = row[i] + (x - i) * (row[i + 1] - row[i]);
    const double got = middlePixel("materials: {m: {components: [{reflection: table, wavelength: [3 um, 5 um], angles: [{angle: " + name +
                                   ", count: 4, last: 90 deg}], values: [[0.3, 0.3], [0.2, 0.2], [0.12, 0.12], [0.02, 0.02]]}]}}\n" + lamp + plateSeenAt(0.0));
    figure("table over " + name + " under a point light [W/(m2 sr)]", got, f * irradiance, 2e-5, "f I cos/d2, f linear between entries; single precision");
  }
  // Two angles and a spectrum: 0.1 at 3 um to 0.2 at 5 um has its mean in the middle; bilinear in the angles.
  const double a = incidence / (60.0 * kDegree), b = 0.5 * incidence / (45.0 * kDegree);
  const double f = (1 - b) * ((1 - a) * 0.15 + a * 0.25) + b * ((1 - a) * 0.05 + a * 0.12);
  const double got = middlePixel(
      "materials: {m: {components: [{reflection: table, wavelength: [3 um, 5 um], angles: [{angle: incidence, count: 2, last: 60 deg}, {angle: half, count: 2, "
      "last: 45 deg}],"
      " values: [[[0.1, 0.2], [0.2, 0.3]], [[0.04, 0.06], [0.1, 0.14]]]}]}}\n" +
      lamp + plateSeenAt(0.0));
  figure("table over incidence and half under a point light [W/(m2 sr)]", got, f * irradiance, 2e-5, "bilinear f, mean over the band; single precision");
}

// What a narrow lobe does not reflect it emits: (1 - R) B.
TEST(Reflection, NarrowLobeEmitsTheRest) {
  for (double view : {0.0, 20.0, 60.0}) {
    double normal = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const double a = 1.1 * kDegree * (i + 0.5) / 20000;
      normal += 900.0 * std::min(1.0, 11.0 - 10.0 * a / kDegree) * std::sin(2.0 * a) * kPi * 1.1 * kDegree / 20000;
    }
    std::string values = "[0, 0]]";
    for (int i = 0; i < 11; ++i) values = "[900, 900], " + values;
    std::string yaml =
        "materials: {m: {components: [{reflection: table, wavelength: [3 um, 5 um], angles: [{angle: specular, count: 12, last: 1.1 deg}], values: [" + values +
        "}]}}\n" + plateSeenAt(view);
    yaml.replace(yaml.find("temperature: 0 K"), 16, "temperature: 500 K");
    figure("plate with a specular disc of 1 deg, 500 K, seen at " + std::to_string(view).substr(0, 4) + " deg [W/(m2 sr)]", middlePixel(yaml),
           (1.0 - normal * std::cos(view * kDegree)) * blackBodyBand(3, 5, 500.0), 1e-5, "(1 - R cos(theta_v)) B; single precision, R of 0.95 leaves 0.05");
  }
}

}  // namespace
}  // namespace pitviper::test
